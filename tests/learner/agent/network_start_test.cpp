// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/network_start.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>

#include "tests/learner/agent/agent_fixture.h"
#include "tests/support/error_message.h"

namespace shoal::learner {
namespace {

using testing::HasSubstr;

Config ConfigFor(const std::string& algorithm, uint64_t seed) {
  Config config = SmallConfig();
  config.learner.algorithm = algorithm;
  config.seed = int64_t(seed);
  return config;
}

class NetworkStartTest : public testing::Test {
 protected:
  static std::unique_ptr<Agent> Make(const std::string& algorithm, uint64_t seed) {
    return MakeAgent(ConfigFor(algorithm, seed), SmallSpec(), nn::Precision::kF32);
  }
  std::string Refusal(const nn::TensorMap& weights) const {
    return UsageMessage([&] { StartTensors(weights, "file", *agent_); });
  }

  const std::unique_ptr<Agent> agent_ = Make("sac", 7), other_ = Make("sac", 8);
};

TEST_F(NetworkStartTest, APolicyStartsThePolicyItsAverageAndItsTarget) {
  for (const char* algorithm : {"sac", "td3"}) {
    const auto agent = Make(algorithm, 7), other = Make(algorithm, 8);
    const nn::TensorMap before = agent->AllTensors(), policy = other->PolicyTensors();
    const nn::TensorMap started = StartTensors(policy, "file", *agent);
    ASSERT_EQ(started.size(), before.size());
    for (const auto& [name, tensor] : policy) {
      EXPECT_EQ(started.at(name).data, tensor.data) << name;
      EXPECT_EQ(started.at("average." + name).data, tensor.data) << name;
      const std::string target = "target_" + name;
      if (!started.contains(target)) continue;
      EXPECT_EQ(started.at(target).data, tensor.data) << target;
    }
    for (const char* name : {"critic.q1.layer0.weight", "target.q2.layer0.weight"}) {
      EXPECT_EQ(started.at(name).data, before.at(name).data) << name;
    }
  }
}

TEST_F(NetworkStartTest, AWholeLearnersFileStartsNetworksButNotItsOptimisers) {
  const RandomBatch batch(SmallSpec(), SmallConfig().learner.batch, 1);
  ASSERT_TRUE(other_->Update(batch.View()).finite);
  const nn::TensorMap before = agent_->AllTensors(), file = other_->AllTensors();
  const nn::TensorMap started = StartTensors(file, "file", *agent_);
  for (const auto& [name, tensor] : started) {
    const bool kept =
        name.starts_with("adam.") || name.starts_with("agent.") || name.starts_with("temperature.");
    EXPECT_EQ(tensor.data, (kept ? before : file).at(name).data) << name;
  }
  EXPECT_NE(file.at("agent.updates").data, before.at("agent.updates").data);
}

// The trained copy must start from the policy as well: it replaces the policy's latent state after
// the first period.
TEST_F(NetworkStartTest, APolicyStartsAllCopiesOfItsLatentState) {
  const auto agent = Make("mrq", 7), other = Make("mrq", 8);
  const nn::TensorMap before = agent->AllTensors(), policy = other->PolicyTensors();
  const nn::TensorMap started = StartTensors(policy, "file", *agent);
  ASSERT_TRUE(policy.contains("actor.trunk.weight") && policy.contains("actor.mlp.output.weight"));
  ASSERT_TRUE(started.contains("model.trunk.weight") &&
              started.contains("model.encoder.conv0.weight"));
  for (const auto& [name, tensor] : policy) {
    EXPECT_EQ(started.at(name).data, tensor.data) << name;
    const bool head = name.starts_with("actor.");
    const std::string part = head ? name.substr(std::strlen("actor.")) : name;
    EXPECT_EQ(started.at("target." + part).data, tensor.data) << part;
    const auto trained = started.find("model." + part);
    if (trained == started.end()) continue;  // the policy's last layers have no trained copy
    EXPECT_EQ(trained->second.data, tensor.data) << part;
  }
  for (const char* name : {"critic.q1.layer0.weight", "model.heads.weight"}) {
    EXPECT_EQ(started.at(name).data, before.at(name).data) << name;
  }
}

TEST_F(NetworkStartTest, CriticsKeepTheScaleOfTheirValues) {
  const auto agent = Make("mrq", 7), other = Make("mrq", 8);
  const Config config = ConfigFor("mrq", 8);
  const RandomBatch batch(SmallSpec(),
                          {.batch = config.learner.batch, .horizon = config.mrq.horizon}, 1);
  ASSERT_TRUE(other->Update(batch.View()).finite);
  const nn::TensorMap file = other->AllTensors();
  ASSERT_NE(file.at("critic.scales").data, agent->AllTensors().at("critic.scales").data);
  EXPECT_EQ(StartTensors(file, "file", *agent).at("critic.scales").data,
            file.at("critic.scales").data);
}

TEST_F(NetworkStartTest, ACriticsTrunkIsNotThatOfThePolicy) {
  const nn::TensorMap started = StartTensors(other_->PolicyTensors(), "file", *agent_);
  ASSERT_TRUE(started.contains("target.trunk.weight"));
  EXPECT_EQ(started.at("target.trunk.weight").data, started.at("critic.trunk.weight").data);
}

TEST_F(NetworkStartTest, ATargetFollowsItsCritic) {
  nn::TensorMap weights = other_->PolicyTensors();
  weights["critic.q1.layer0.weight"] = other_->AllTensors().at("critic.q1.layer0.weight");
  EXPECT_EQ(StartTensors(weights, "file", *agent_).at("target.q1.layer0.weight").data,
            weights.at("critic.q1.layer0.weight").data);
}

TEST_F(NetworkStartTest, WhatDoesNotFitIsRefusedByName) {
  const nn::TensorMap policy = other_->PolicyTensors();
  nn::TensorMap weights = policy;
  weights.erase("actor.mlp.output.bias");
  EXPECT_THAT(Refusal(weights), HasSubstr("file: tensor actor.mlp.output.bias is missing"));
  weights = policy;
  weights.at("actor.mlp.output.bias").shape = {1, 4};
  EXPECT_THAT(Refusal(weights),
              HasSubstr("file: tensor actor.mlp.output.bias has shape 1x4, expected 4"));
  weights = policy;
  weights["actor.mlp.layer9.bias"] = policy.at("actor.mlp.output.bias");
  EXPECT_THAT(Refusal(weights), HasSubstr("tensor actor.mlp.layer9.bias is none of"));
  weights = policy;
  weights.at("actor.mlp.output.bias").dtype = "BF16";
  EXPECT_THAT(Refusal(weights), HasSubstr("tensor actor.mlp.output.bias is BF16, expected F32"));
  weights = policy;
  const float infinite = INFINITY;
  std::memcpy(weights.at("actor.mlp.output.bias").data.data(), &infinite, sizeof(infinite));
  EXPECT_THAT(Refusal(weights), HasSubstr("tensor actor.mlp.output.bias holds inf"));
  weights = policy;
  weights["observation.mean"] = policy.at("actor.mlp.output.bias");
  EXPECT_THAT(Refusal(weights), HasSubstr("expected that file"));
}

}  // namespace
}  // namespace shoal::learner
