// SPDX-License-Identifier: Apache-2.0
// Restoring SAC agents from their tensors.
#include <gmock/gmock.h>

#include "common/base/error.h"
#include "tests/learner/agent/sac_agent_fixture.h"

namespace shoal::learner {
namespace {

using nn::Precision;
using nn::TensorMap;
using testing::IsEmpty;

void ExpectExactRestart(const Config& config, Precision precision, int updates) {
  const auto original = SmallAgent(config, precision), restored = SmallAgent(config, precision);
  UpdateTimes(original.get(), 7);
  // Through the bytes of a file, as a checkpoint does.
  restored->Restore(
      nn::ReadSafetensors(nn::WriteSafetensors(original->AllTensors(), {}), "checkpoint"),
      "checkpoint");
  EXPECT_EQ(restored->updates(), 7u);
  UpdateTimes(original.get(), updates, 500);
  UpdateTimes(restored.get(), updates, 500);
  EXPECT_THAT(Differences(original->AllTensors(), restored->AllTensors()), IsEmpty());
}

TEST(SacRestore, RestoredAgentGoesOnByteForByteForAHundredUpdates) {
  for (const Precision precision : Precisions()) ExpectExactRestart(SmallConfig(), precision, 100);
}

// The critics of a target are drawn from the update's stream, so a restored agent draws the same
// critics.
TEST(SacRestore, RestoredAgentGoesOnByteForByteWithAnEnsemble) {
  Config config = SmallConfig();
  config.sac.critics = 5;
  config.sac.target_critics = 2;
  config.sac.actor_value = "mean";
  ExpectExactRestart(config, Precision::kF32, 20);
}

TEST(SacRestore, RestoredAgentGoesOnByteForByteWithFurtherEncoders) {
  for (const bool target : {false, true}) {
    for (const char* encoders : {"shared", "separate"}) {
      ExpectExactRestart(WithEncoders(encoders, target), Precision::kF32, 3);
    }
  }
}

TEST(SacRestore, RestoreRefusesWhatDoesNotFitAndChangesNothing) {
  const auto agent = SmallAgent(SmallConfig()), other = SmallAgent(SmallConfig());
  UpdateTimes(other.get(), 2);
  const TensorMap before = agent->AllTensors();
  for (const char* name : {"encoder.conv1.bias", "actor.mlp.output.weight", "target.q2.output.bias",
                           "adam.v.critic.q1.layer0.weight", "adam.steps.temperature",
                           "temperature.log", "agent.updates"}) {
    TensorMap tensors = other->AllTensors();
    ASSERT_EQ(tensors.count(name), 1u) << name;
    tensors.at(name).shape.push_back(2);
    EXPECT_THROW(agent->Restore(tensors, "checkpoint"), Error) << name;
    tensors.erase(name);
    EXPECT_THAT([&] { agent->Restore(tensors, "checkpoint 5"); },
                testing::ThrowsMessage<Error>(
                    testing::AllOf(testing::HasSubstr("checkpoint 5"), testing::HasSubstr(name))));
    EXPECT_THAT(Differences(before, agent->AllTensors()), IsEmpty()) << name;
  }
  // The layers too: both go on alike.
  const auto untouched = SmallAgent(SmallConfig());
  UpdateTimes(agent.get(), 2);
  UpdateTimes(untouched.get(), 2);
  EXPECT_THAT(Differences(agent->AllTensors(), untouched->AllTensors()), IsEmpty());
}

// A checkpoint of twins does not fit an ensemble, nor the other way round. The first tensor that is
// missing or surplus is named.
TEST(SacRestore, AnEnsembleKeepsTheNamesOfTheTwinsAndNeitherTakesTheOthersCheckpoint) {
  Config config = SmallConfig();
  config.sac.critics = 3;
  const auto twins = SmallAgent(SmallConfig()), three = SmallAgent(config);
  const TensorMap of_twins = twins->AllTensors(), of_three = three->AllTensors();
  for (const auto& [name, tensor] : of_twins) {
    ASSERT_TRUE(of_three.contains(name)) << name;
    EXPECT_EQ(of_three.at(name).data, tensor.data) << name;
  }
  for (const auto& [name, tensor] : of_three) {
    EXPECT_NE(of_twins.contains(name), name.find(".q3.") != std::string::npos) << name;
  }
  EXPECT_NE(of_three.at("critic.q3.layer0.weight").data,
            of_three.at("critic.q2.layer0.weight").data);
  EXPECT_THAT([&] { three->Restore(of_twins, "checkpoint 5"); },
              testing::ThrowsMessage<Error>(
                  testing::AllOf(testing::HasSubstr("checkpoint 5"), testing::HasSubstr("q3"))));
  EXPECT_THAT([&] { twins->Restore(of_three, "checkpoint 5"); },
              testing::ThrowsMessage<Error>(
                  testing::AllOf(testing::HasSubstr("checkpoint 5"), testing::HasSubstr("q3"))));
  EXPECT_THAT(Differences(twins->AllTensors(), of_twins), IsEmpty());
}

}  // namespace
}  // namespace shoal::learner
