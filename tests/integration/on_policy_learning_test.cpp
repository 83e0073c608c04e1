// SPDX-License-Identifier: Apache-2.0
// PPO from state, through the real processes, until nine of ten episodes succeed.
#include <gtest/gtest.h>

#include "tests/support/learning_run.h"

namespace shoal {
namespace {

// At about 57,000 env steps, half a minute on two busy cores.
TEST(OnPolicyLearning, FetchReachReachesNinetyPercentFromState) {
  const LearningResult learned =
      Learn("fetch-reach-ppo",
            {{"env_steps", "250000"}, {"stop.evaluations", "1"}, {"stop.success", "0.9"}},
            std::chrono::seconds(500));
  EXPECT_EQ(learned.meta.at("exit"), "target");
  ExpectSuccess(learned, "FetchReachDense", 0.85);
}

}  // namespace
}  // namespace shoal
