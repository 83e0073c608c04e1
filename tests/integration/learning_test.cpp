// SPDX-License-Identifier: Apache-2.0
// SAC, TD3, DDPG and hindsight on FetchReach from state, through the real processes.
#include <gtest/gtest.h>

#include "tests/support/learning_run.h"

namespace shoal {
namespace {

constexpr double kLeast = 0.9;

TEST(Learning, FetchReachDenseFromStateReachesNinetyPercent) {
  const LearningResult learned =
      LearnGoals("fetch-reach-state", {{"stop.success", "0.95"}}, kLeast);
  EXPECT_EQ(learned.aggregate.at("episodes"), 50);
  ExpectSuccess(learned, "FetchReachDense", kLeast);
}

TEST(Learning, Td3ReachesNinetyPercentFromState) {
  ExpectSuccess(LearnGoals("fetch-reach-state-td3", {{"stop.success", "0.95"}}, kLeast),
                "FetchReachDense", kLeast);
}

TEST(Learning, DdpgReachesNinetyPercentFromState) {
  ExpectSuccess(LearnGoals("fetch-reach-state-ddpg", {{"stop.success", "0.95"}}, kLeast),
                "FetchReachDense", kLeast);
}

// Rewards of -1 and 0 alone: of a policy that rarely reaches its goals nearly all are -1.
TEST(Learning, HindsightReachesNinetyPercentOfSparseGoals) {
  const LearningResult learned =
      LearnGoals("fetch-reach-her",
                 {{"env_steps", "8000"}, {"eval.interval", "2000"}, {"stop.success", "2"}}, kLeast);
  EXPECT_EQ(learned.aggregate.at("episodes"), 100);
  ExpectSuccess(learned, "FetchReach", kLeast);
}

}  // namespace
}  // namespace shoal
