// SPDX-License-Identifier: Apache-2.0
#include "common/base/watchdog.h"

#include <gtest/gtest.h>

#include <semaphore>

namespace shoal {
namespace {

using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

TEST(Watchdog, LeavesTheProcessAloneWhenItEndsInTime) {
  const SteadyTime start = Now();
  { const Watchdog watchdog("nothing", minutes(10)); }
  EXPECT_LT(Now() - start, seconds(60)) << "its end does not wait for the limit";
}

TEST(WatchdogDeathTest, EndsTheProcessNamingWhatTookTooLong) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto hang = [] {
    const Watchdog watchdog("closing the valve", milliseconds(20));
    std::binary_semaphore never(0);
    (void)never.try_acquire_for(minutes(1));
  };
  EXPECT_EXIT(hang(), testing::ExitedWithCode(1),
              "closing the valve took longer than 20 ms: leaving at once");
}

}  // namespace
}  // namespace shoal
