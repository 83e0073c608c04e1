// SPDX-License-Identifier: Apache-2.0
#include "common/intake/session_clock.h"

#include <gtest/gtest.h>

namespace shoal {
namespace {

constexpr uint64_t kSecond = 1'000'000'000, kMargin = 600 * kSecond;

TEST(SessionClock, FollowsTheClockByTheMargin) {
  SessionClock clock(100 * kSecond);
  EXPECT_EQ(clock.Latest(101'000'000'000), 101 * kSecond + kMargin);
  EXPECT_EQ(clock.Latest(5'000'000'000'000), 5000 * kSecond + kMargin);
}

TEST(SessionClock, AClockThatIsSetBackDoesNotLowerIt) {
  SessionClock clock(100 * kSecond);
  EXPECT_EQ(clock.Latest(5'000'000'000'000), 5000 * kSecond + kMargin);
  EXPECT_EQ(clock.Latest(1'000'000'000), 5000 * kSecond + kMargin);
  EXPECT_EQ(clock.Latest(-1), 5000 * kSecond + kMargin);
}

TEST(SessionClock, IsNeverBelowTheReceiversOwnSession) {
  SessionClock clock(100 * kSecond);
  EXPECT_EQ(clock.Latest(1'000'000'000), 100 * kSecond + kMargin);
}

}  // namespace
}  // namespace shoal
