// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/restart_backoff.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace shoal::launch {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::ElementsAre;

constexpr BackoffLimits kBackoff{.first_delay = milliseconds(100),
                                 .longest_delay = milliseconds(1000),
                                 .window = seconds(60),
                                 .healthy = seconds(600)};

std::vector<int64_t> Delays(RestartBackoff* backoff, const std::vector<milliseconds>& lives) {
  std::vector<int64_t> delays;
  for (const milliseconds life : lives) delays.push_back(backoff->OnDeath(life).delay.count());
  return delays;
}

TEST(RestartBackoff, DoublesTheDelayUpToTheLongestAndNeverGivesUp) {
  RestartBackoff backoff(kBackoff);
  EXPECT_THAT(Delays(&backoff, std::vector<milliseconds>(6)),
              ElementsAre(100, 200, 400, 800, 1000, 1000));
  for (int i = 0; i < 10'000; ++i) EXPECT_EQ(backoff.OnDeath({}).delay, seconds(1));
}

TEST(RestartBackoff, ByDefaultWaitsUpToAMinute) {
  RestartBackoff backoff{BackoffLimits()};
  for (int i = 0; i < 20; ++i) backoff.OnDeath({});
  EXPECT_EQ(backoff.OnDeath({}).delay, seconds(60));
}

// Four deaths lie within a minute of work, whatever the time between them.
TEST(RestartBackoff, CountsTheDeathsOfTheLastMinuteOfWork) {
  RestartBackoff backoff(kBackoff);
  EXPECT_THAT(Delays(&backoff, std::vector<milliseconds>(8, seconds(20))),
              ElementsAre(100, 200, 400, 800, 800, 800, 800, 800));
  EXPECT_EQ(backoff.OnDeath(seconds(61)).delay, milliseconds(100));
}

TEST(RestartBackoff, AnnouncesTheFirstDeathAndEachDoubling) {
  RestartBackoff backoff(kBackoff);
  std::vector<int> announced;
  for (int i = 0; i < 100; ++i) {
    const RestartBackoff::Restart restart = backoff.OnDeath(seconds(100));
    EXPECT_EQ(restart.deaths, i + 1);
    if (restart.announce) announced.push_back(restart.deaths);
  }
  EXPECT_THAT(announced, ElementsAre(1, 2, 4, 8, 16, 32, 64));
}

TEST(RestartBackoff, CountsAnewAfterALongTimeOfWork) {
  RestartBackoff backoff(kBackoff);
  for (int i = 0; i < 5; ++i) backoff.OnDeath({});
  EXPECT_EQ(backoff.OnDeath(seconds(599)).deaths, 6);
  const RestartBackoff::Restart restart = backoff.OnDeath(seconds(600));
  EXPECT_EQ(restart.deaths, 1);
  EXPECT_TRUE(restart.announce);
}

}  // namespace
}  // namespace shoal::launch
