// SPDX-License-Identifier: Apache-2.0
// SAC, TD3, DDPG and hindsight on FetchReach from state, through the real processes.
#include <gtest/gtest.h>

#include "tests/support/learning_run.h"

namespace shoal {
namespace {

using std::chrono::seconds;

TEST(Learning, FetchReachDenseFromStateReachesNinetyPercent) {
  const LearningResult learned =
      Learn("fetch-reach-state", {{"stop.success", "0.95"}}, seconds(300));
  EXPECT_EQ(learned.aggregate.at("episodes"), 50);
  ExpectSuccess(learned, "FetchReachDense", 0.9);
}

TEST(Learning, Td3ReachesNinetyPercentFromState) {
  ExpectSuccess(Learn("fetch-reach-state-td3", {{"stop.success", "0.95"}}, seconds(300)),
                "FetchReachDense", 0.9);
}

TEST(Learning, DdpgReachesNinetyPercentFromState) {
  ExpectSuccess(Learn("fetch-reach-state-ddpg", {{"stop.success", "0.95"}}, seconds(300)),
                "FetchReachDense", 0.9);
}

// Rewards of -1 and 0 alone: of a policy that rarely reaches its goals nearly all are -1.
TEST(Learning, HindsightReachesNinetyPercentOfSparseGoals) {
  const LearningResult learned = Learn(
      "fetch-reach-her", {{"env_steps", "8000"}, {"eval.interval", "2000"}, {"stop.success", "2"}},
      seconds(300));
  EXPECT_EQ(learned.aggregate.at("episodes"), 100);
  ExpectSuccess(learned, "FetchReach", 0.9);
}

}  // namespace
}  // namespace shoal
