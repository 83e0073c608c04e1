// SPDX-License-Identifier: Apache-2.0
// Small SAC agents and their updates.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "learner/agent/sac/sac_agent.h"
#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {

inline std::unique_ptr<Agent> SmallAgent(const Config& config,
                                         nn::Precision precision = nn::Precision::kF32) {
  return MakeAgent(config, SmallSpec(), precision);
}

inline void UpdateTimes(Agent* agent, int updates, uint64_t first_key = 100) {
  for (int u = 0; u < updates; ++u) {
    const RandomBatch batch(SmallSpec(), SmallConfig().learner.batch, first_key + uint64_t(u));
    ASSERT_TRUE(agent->Update(batch.View()).finite);
  }
}

// Both precisions where the CPU has them.
inline std::vector<nn::Precision> Precisions() {
  if (nn::ChoosePrecision("auto", /*pixels=*/true) == nn::Precision::kBf16)
    return {nn::Precision::kF32, nn::Precision::kBf16};
  return {nn::Precision::kF32};
}

inline Config WithEncoders(const char* encoders, bool target_encoder) {
  Config config = SmallConfig();
  config.network.encoders = encoders;
  config.network.target_encoder = target_encoder;
  return config;
}

}  // namespace shoal::learner
