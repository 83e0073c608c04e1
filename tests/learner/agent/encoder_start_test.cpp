// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/encoder_start.h"

#include <gtest/gtest.h>

#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

TEST(EncoderStart, ReachesTheEncoderAndItsAverageAndNothingElse) {
  for (const char* algorithm : {"sac", "td3"}) {
    Config config = SmallConfig(), other = SmallConfig();
    config.learner.algorithm = other.learner.algorithm = algorithm;
    other.seed = 8;
    const auto agent = MakeAgent(config, SmallSpec(), nn::Precision::kF32);
    const auto source = MakeAgent(other, SmallSpec(), nn::Precision::kF32);
    nn::TensorMap weights;
    for (const auto& [name, tensor] : source->PolicyTensors()) {
      if (name.starts_with("encoder.")) weights[name] = tensor;
    }
    ASSERT_EQ(weights.size(), 4u);
    const nn::TensorMap before = agent->AllTensors();
    StartEncoder(weights, agent.get());
    const nn::TensorMap after = agent->AllTensors();
    ASSERT_EQ(after.size(), before.size());
    for (const auto& [name, tensor] : after) {
      const std::string average = "average.";
      const std::string bare = name.starts_with(average) ? name.substr(average.size()) : name;
      const nn::TensorMap& expected = weights.contains(bare) ? weights : before;
      EXPECT_EQ(tensor.data, expected.at(weights.contains(bare) ? bare : name).data) << name;
    }
    EXPECT_NE(after.at("encoder.conv0.weight").data, before.at("encoder.conv0.weight").data);

    // The layers have them: its first update is that of an agent that always had them.
    nn::TensorMap whole = before;
    for (const auto& [name, tensor] : weights) whole[name] = whole["average." + name] = tensor;
    const auto restored = MakeAgent(config, SmallSpec(), nn::Precision::kF32);
    restored->Restore(whole, "test");
    const RandomBatch batch(SmallSpec(), config.learner.batch, 1);
    EXPECT_EQ(Get(agent->Update(batch.View()), kCriticLoss),
              Get(restored->Update(batch.View()), kCriticLoss));
  }
}

}  // namespace
}  // namespace shoal::learner
