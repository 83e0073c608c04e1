// SPDX-License-Identifier: Apache-2.0
// SAC from pixels alone, through the real processes: rendering, records, stacks, shifts, encoder,
// arithmetic in bf16 if the CPU has it, and weights for the actors.
#include <gtest/gtest.h>

#include "tests/support/learning_run.h"

namespace shoal {
namespace {

// The fastest recipe, ended after 30,000 of its 52,000 env steps. The pictures
// alone show the goal.
TEST(PixelsLearning, FetchReachDenseReachesEightyFivePercent) {
  const LearningResult learned =
      Learn("fetch-reach-fast",
            {{"env_steps", "30000"}, {"eval.episodes", "20"}, {"eval.interval", "10000"}},
            std::chrono::seconds(550));
  EXPECT_EQ(learned.aggregate.at("episodes"), 100);
  ExpectSuccess(learned, "FetchReachDense", 0.85);
}

}  // namespace
}  // namespace shoal
