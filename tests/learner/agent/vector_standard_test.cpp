// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/vector_standard.h"

#include <gtest/gtest.h>

#include "common/nn/actor_critic_plan.h"
#include "common/nn/vector_scale.h"
#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

TEST(RunningMoments, OfTwoBatchesAreThoseOfAllNumbers) {
  RunningMoments moments(2);
  moments.Add(std::vector<float>{1, 10, 2, 20});
  moments.Add(std::vector<float>{6, 60});
  EXPECT_EQ(moments.Mean(), (std::vector<float>{3, 30}));
  EXPECT_NEAR(moments.Variance()[0], 14.0 / 3, 1e-6);
  nn::TensorMap tensors;
  moments.Export("m", &tensors);
  RunningMoments other(2);
  other.Import(tensors, "m", "test");
  EXPECT_EQ(other.Variance(), moments.Variance());
  EXPECT_EQ(other.count(), 3);
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
  plain->Restore(agent->AllTensors(), "agent");
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

INSTANTIATE_TEST_SUITE_P(Of, VectorStandardTest, testing::Values("sac", "td3", "ddpg"));

}  // namespace
}  // namespace shoal::learner
