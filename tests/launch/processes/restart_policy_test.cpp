// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/restart_policy.h"

#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr RestartLimits kLimits{.restarts = 4,
                                .window = seconds(60),
                                .first_delay = milliseconds(100),
                                .longest_delay = milliseconds(300)};

TEST(RestartPolicy, DoublesTheDelayUpToTheLongest) {
  RestartPolicy policy(kLimits);
  const SteadyTime t;
  EXPECT_EQ(policy.OnDeath(t), milliseconds(100));
  EXPECT_EQ(policy.OnDeath(t), milliseconds(200));
  EXPECT_EQ(policy.OnDeath(t), milliseconds(300));
  EXPECT_EQ(policy.OnDeath(t), milliseconds(300));
}

TEST(RestartPolicy, GivesUpAfterTheLimitWithinTheWindow) {
  RestartPolicy policy(kLimits);
  const SteadyTime t;
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(policy.OnDeath(t + seconds(i)).has_value());
  EXPECT_FALSE(policy.OnDeath(t + seconds(59)).has_value());
}

TEST(RestartPolicy, ForgetsDeathsOlderThanTheWindow) {
  RestartPolicy policy(kLimits);
  const SteadyTime t;
  for (int i = 0; i < 4; ++i) policy.OnDeath(t + seconds(i));
  EXPECT_EQ(policy.OnDeath(t + seconds(100)), milliseconds(100));
}

}  // namespace
}  // namespace shoal::launch
