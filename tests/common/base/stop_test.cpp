// SPDX-License-Identifier: Apache-2.0
#include "common/base/stop.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>

namespace shoal {
namespace {

// Exit code of a fresh process: the stop requests counted after the signals, 100 more when a stop
// is requested at all.
void CountRequests(std::initializer_list<int> signals) {
  InstallStopSignals();
  for (const int signal : signals) raise(signal);
  _exit(StopRequests() + (StopRequested() ? 100 : 0));
}

TEST(Stop, EachCtrlCCounts) {
  EXPECT_EXIT(CountRequests({}), testing::ExitedWithCode(0), "");
  EXPECT_EXIT(CountRequests({SIGINT, SIGINT, SIGTERM}), testing::ExitedWithCode(103), "");
}

TEST(Stop, AHangUpAsksForAStopButNeverForHaste) {
  EXPECT_EXIT(CountRequests({SIGHUP, SIGHUP, SIGHUP}), testing::ExitedWithCode(100), "");
  EXPECT_EXIT(CountRequests({SIGINT, SIGHUP}), testing::ExitedWithCode(101), "");
}

TEST(Stop, AnIgnoredHangUpStaysIgnored) {
  const auto under_nohup = [] {
    signal(SIGHUP, SIG_IGN);
    CountRequests({SIGHUP});
  };
  EXPECT_EXIT(under_nohup(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace shoal
