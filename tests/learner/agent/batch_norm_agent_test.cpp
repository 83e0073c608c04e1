// SPDX-License-Identifier: Apache-2.0
// Requirements of batch normalisation in the encoder: trained passes use statistics of the batch,
// targets use running statistics, and running statistics are saved like other state.
#include <gmock/gmock.h>

#include "learner/agent/algorithms.h"
#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

constexpr const char* kMean = "encoder.layer2.0.bn1.running_mean";
constexpr const char* kVariance = "encoder.bn1.running_var";

class BatchNormAgentTest : public testing::TestWithParam<const char*> {
 protected:
  BatchNormAgentTest() {
    config_.learner.algorithm = GetParam();
    config_.network.encoder = "resnet18";
    config_.network.filters.clear();
    config_.network.strides.clear();
    config_.network.initialisation = "pytorch";  // fast
    config_.learner.average_rate = 0.25;
    agent_ = MakeAgent(config_, SmallSpec(), nn::Precision::kF32);
  }

  RandomBatch Batch(uint64_t key) const { return {SmallSpec(), config_.learner.batch, key}; }

  Config config_ = SmallConfig();
  std::unique_ptr<Agent> agent_;
};

TEST_P(BatchNormAgentTest, TargetsDoNotDependOnTheOthersOfABatch) {
  const RandomBatch batch = Batch(1), other = Batch(1);
  batch.View().bootstrap[0] = other.View().bootstrap[0] = 0;  // its next observation counts nowhere
  for (size_t b = 1; b < batch.View().bootstrap.size(); ++b) {
    batch.View().bootstrap[b] = other.View().bootstrap[b] = 1;
  }
  const BatchView changed = other.View();
  for (size_t i = 0; i < changed.next_obs_frames.size() / changed.bootstrap.size(); ++i) {
    changed.next_obs_frames[i] = uint8_t(changed.next_obs_frames[i] / 3);
  }
  const auto same = MakeAgent(config_, SmallSpec(), nn::Precision::kF32);
  EXPECT_EQ(Get(agent_->Update(batch.View()), kTargetMean),
            Get(same->Update(other.View()), kTargetMean));
}

TEST_P(BatchNormAgentTest, RunningStatisticsFollowTheBatchAndAreCopiedWhole) {
  const auto before = Floats(agent_->PolicyTensors(), kMean);
  ASSERT_TRUE(agent_->Update(Batch(1).View()).finite);
  ASSERT_TRUE(agent_->Update(Batch(2).View()).finite);
  const nn::TensorMap policy = agent_->PolicyTensors(), average = agent_->AveragedPolicyTensors();
  for (const char* name : {kMean, kVariance}) {
    EXPECT_EQ(policy.at(name).data, average.at(name).data) << name;
  }
  EXPECT_NE(Floats(policy, kMean), before);
  EXPECT_NE(policy.at("encoder.bn1.weight").data, average.at("encoder.bn1.weight").data);
  EXPECT_FALSE(agent_->AllTensors().contains(std::string("adam.m.") + kMean));
}

TEST_P(BatchNormAgentTest, AnUpdateThatIsNotFiniteLeavesStatisticsAsTheyWere) {
  ASSERT_TRUE(agent_->Update(Batch(1).View()).finite);
  const nn::TensorMap before = agent_->AllTensors();
  const RandomBatch batch = Batch(2);
  batch.View().reward[1] = 1e25f;  // finite, but its squared error is not
  EXPECT_FALSE(agent_->Update(batch.View()).finite);
  const nn::TensorMap after = agent_->AllTensors();
  for (const auto& [name, tensor] : before) EXPECT_EQ(after.at(name).data, tensor.data) << name;
}

TEST_P(BatchNormAgentTest, GoesOnByteForByteFromWhatItExported) {
  ASSERT_TRUE(agent_->Update(Batch(1).View()).finite);
  const auto restored = MakeAgent(config_, SmallSpec(), nn::Precision::kF32);
  restored->Restore(agent_->AllTensors(), "original");
  for (uint64_t u = 2; u < 5; ++u) {
    agent_->Update(Batch(u).View());
    restored->Update(Batch(u).View());
  }
  const nn::TensorMap one = agent_->AllTensors(), other = restored->AllTensors();
  ASSERT_EQ(one.size(), other.size());
  for (const auto& [name, tensor] : one) EXPECT_EQ(other.at(name).data, tensor.data) << name;
}

INSTANTIATE_TEST_SUITE_P(Of, BatchNormAgentTest, testing::Values("sac", "td3"),
                         [](const auto& each) { return std::string(each.param); });

}  // namespace
}  // namespace shoal::learner
