// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/vector_standard.h"

#include <gtest/gtest.h>

#include "common/nn/actor_critic_plan.h"
#include "common/nn/vector_scale.h"
#include "learner/agent/running_moments.h"
#include "learner/engine/cpu_engine.h"
#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

TEST(VectorStandard, AVarianceBelowTheFloorCountsAsTheFloor) {
  const ObservationSpec spec = SmallSpec();
  const RandomBatch batch(spec, 6, 1);
  const BatchView view = batch.View();
  for (size_t i = 0; i < view.obs_vector.size(); i += 2) {
    view.obs_vector[i] = 1 + 1e-4f * float(i);  // hardly varies
    view.next_obs_vector[i] = 1.05f;
    view.next_obs_vector[i + 1] = 0.5f;
  }
  RunningMoments moments(2);
  moments.Add(view.obs_vector);
  const float small = moments.Variance()[0], usual = moments.Variance()[1];
  ASSERT_LT(small, 1e-6f);
  ASSERT_GT(usual, 0.01f);
  const auto look = [&](double floor) {
    LearnerConfig learner;
    learner.normalise_vectors = true;
    learner.variance_floor = floor;
    nn::Replica alone;
    CpuEngine engine(nn::Precision::kF32, 6, &alone);
    VectorStandard standard(learner, &engine, 2);
    standard.Add(view);
    nn::TensorMap policy;
    standard.ExportTo(&policy);
    const Transitions seen = standard.Seen(engine.Take(view));
    return std::pair(Floats(policy, nn::kObservationVariance),
                     engine.ReadRows(seen.next_obs_vector)[0]);
  };
  const auto [variance, seen] = look(0);
  EXPECT_EQ(variance, moments.Variance());
  EXPECT_EQ(seen, 10) << "far beyond its deviation of 0.0003";
  const auto [floored, seen_with_floor] = look(1e-4);
  EXPECT_EQ(floored, (std::vector<float>{1e-4f, usual})) << "actors scale by it, too";
  EXPECT_NEAR(seen_with_floor, (1.05f - moments.Mean()[0]) / 0.01f, 0.01f);
}

class VectorStandardTest : public testing::TestWithParam<const char*> {
 protected:
  std::unique_ptr<Agent> Make(bool normalise) const {
    Config config = SmallConfig();
    config.learner.algorithm = GetParam();
    config.learner.normalise_vectors = normalise;
    return MakeAgent(config, spec_, nn::Precision::kF32);
  }

  const ObservationSpec spec_ = SmallSpec();
};

TEST_P(VectorStandardTest, MomentsOfAllVectorsBelongToThePolicy) {
  const auto agent = Make(true), plain = Make(false);
  RunningMoments moments(2);
  for (uint64_t u = 0; u < 3; ++u) {
    const RandomBatch batch(spec_, SmallConfig().learner.batch, u);
    moments.Add(batch.View().obs_vector);
    ASSERT_TRUE(agent->Update(batch.View()).finite);
    ASSERT_TRUE(plain->Update(batch.View()).finite);
  }
  for (const nn::TensorMap& policy : {agent->PolicyTensors(), agent->AveragedPolicyTensors()}) {
    EXPECT_EQ(Floats(policy, nn::kObservationMean), moments.Mean());
    EXPECT_EQ(Floats(policy, nn::kObservationVariance), moments.Variance());
  }
  EXPECT_FALSE(plain->PolicyTensors().contains(nn::kObservationMean));
}

// An update is that of a plain agent with the same parameters on vectors scaled by the moments of
// the updates before.
TEST_P(VectorStandardTest, TheNetworksSeeScaledVectors) {
  const auto agent = Make(true), plain = Make(false);
  for (uint64_t u = 0; u < 3; ++u) {
    const RandomBatch batch(spec_, SmallConfig().learner.batch, u);
    const BatchView view = batch.View();
    for (float& x : view.obs_vector) x = 50 + 7 * x;
    for (float& x : view.next_obs_vector) x = 50 + 7 * x;
    ASSERT_TRUE(agent->Update(view).finite);
  }
  nn::TensorMap networks = agent->AllTensors();
  networks.erase("observation.moments");
  plain->Restore(networks, "agent");
  const RandomBatch batch(spec_, SmallConfig().learner.batch, 9), scaled(spec_, 6, 9);
  const nn::TensorMap policy = agent->PolicyTensors();
  const nn::VectorScale scale(Floats(policy, nn::kObservationMean),
                              Floats(policy, nn::kObservationVariance));
  scale.Apply(batch.View().obs_vector.data(), scaled.View().obs_vector);
  scale.Apply(batch.View().next_obs_vector.data(), scaled.View().next_obs_vector);
  const UpdateOutcome a = agent->Update(batch.View()), b = plain->Update(scaled.View());
  EXPECT_EQ(Get(a, kCriticLoss), Get(b, kCriticLoss));
  EXPECT_EQ(Get(a, kTargetMean), Get(b, kTargetMean));
  nn::TensorMap after = agent->AllTensors();
  after.erase("observation.moments");
  EXPECT_TRUE(Differences(after, plain->AllTensors()).empty());
}

TEST_P(VectorStandardTest, ARestoredAgentGoesOnBitForBit) {
  const auto one = Make(true), other = Make(true);
  for (uint64_t u = 0; u < 3; ++u) {
    ASSERT_TRUE(one->Update(RandomBatch(spec_, SmallConfig().learner.batch, u).View()).finite);
  }
  other->Restore(one->AllTensors(), "test");
  const RandomBatch next(spec_, SmallConfig().learner.batch, 9);
  ASSERT_TRUE(one->Update(next.View()).finite);
  ASSERT_TRUE(other->Update(next.View()).finite);
  EXPECT_TRUE(Differences(one->AllTensors(), other->AllTensors()).empty());
}

INSTANTIATE_TEST_SUITE_P(Of, VectorStandardTest, testing::Values("sac", "td3", "ddpg", "drqv2"));

}  // namespace
}  // namespace shoal::learner
