// SPDX-License-Identifier: Apache-2.0
// Processes that run and do not report.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/launch/processes/supervisor_fixture.h"
#include "tests/launch/wait_until.h"

namespace shoal::launch {
namespace {

using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Matches;

// Looks twice a second of the supervisor's time until something is said; the time it took.
std::chrono::milliseconds TimerUntilSaid(Supervisor* supervisor,
                                         const std::vector<std::string>& said, SteadyTime start) {
  SteadyTime now = start;
  while (said.empty() && now < start + std::chrono::hours(1)) {
    now += milliseconds(500);
    EXPECT_EQ(supervisor->Poll(now), std::nullopt);
  }
  return std::chrono::duration_cast<milliseconds>(now - start);
}

TEST_F(SupervisorTest, KillsAndRestartsAProcessThatSaysNothingAnyMore) {
  supervisor_.Start(Fake("learner", 0, "kill -STOP $$"));
  ASSERT_TRUE(WaitUntil([&] { return Starts("learner-0") == 1; }));
  const SteadyTime start = Now();
  supervisor_.Heard("learner", 0, supervisor_.Pid("learner", 0), start);
  const milliseconds silence = TimerUntilSaid(&supervisor_, said_, start);
  EXPECT_EQ(silence, HangLimits().report + milliseconds(500));
  ASSERT_THAT(said_, ElementsAre(AllOf(HasSubstr("learner-0"), HasSubstr("hangs"),
                                       HasSubstr("no report for 30 s"))));
  EXPECT_TRUE(PollUntil([&] { return Starts("learner-0") == 2; }));
  EXPECT_THAT(said_[1], HasSubstr("learner-0: killed by SIGKILL"));
}

TEST_F(SupervisorTest, GivesAProcessLongerForItsFirstReport) {
  supervisor_.Start(Fake("replay", 0, "exec sleep 60"));
  const SteadyTime start = Now();
  const pid_t predecessor = 1;
  supervisor_.Heard("replay", 0, predecessor, start);
  EXPECT_GE(TimerUntilSaid(&supervisor_, said_, start), HangLimits().start);
  EXPECT_THAT(said_, ElementsAre(HasSubstr("no report for 120 s")));
}

// Pids of two hosts are independent. The local child of a remote actor is the remote shell; in this
// test the remote actor has the same pid as the local actor.
TEST_F(SupervisorTest, HearsAProcessElsewhereWhateverItsPid) {
  ProcessSpec there = Fake("actor", 1, "exec sleep 60");
  there.elsewhere = true;
  supervisor_.Start(Fake("actor", 0, "exec sleep 60"));
  supervisor_.Start(there);
  const pid_t pid = supervisor_.Pid("actor", 0);
  ASSERT_NE(pid, supervisor_.Pid("actor", 1));
  const SteadyTime start = Now();
  supervisor_.Heard("actor", 0, pid, start);
  SteadyTime now = start;
  while (said_.empty() && now < start + HangLimits().start) {
    supervisor_.Heard("actor", 1, pid, now);
    now += milliseconds(500);
    EXPECT_EQ(supervisor_.Poll(now), std::nullopt);
  }
  EXPECT_THAT(said_, ElementsAre(AllOf(HasSubstr("actor-0"), HasSubstr("no report for 30 s"))))
      << "its reports are not those of the actor here";
  // Between them the death of the first actor may be noticed and reported.
  const auto silence = AllOf(HasSubstr("actor-1"), HasSubstr("no report for 30 s"));
  const SteadyTime end = now + HangLimits().start;
  while (!Matches(Contains(silence))(said_) && now < end) {
    now += milliseconds(500);
    EXPECT_EQ(supervisor_.Poll(now), std::nullopt);
  }
  EXPECT_THAT(said_, Contains(silence)) << "it had been heard";
}

TEST_F(SupervisorTest, DoesNotTakeItsOwnAbsenceForAHang) {
  supervisor_.Start(Fake("actor", 0, "exec sleep 60"));
  const SteadyTime start = Now();
  supervisor_.Heard("actor", 0, supervisor_.Pid("actor", 0), start);
  EXPECT_EQ(supervisor_.Poll(start + std::chrono::hours(1)), std::nullopt);
  EXPECT_THAT(said_, IsEmpty());
}

TEST_F(SupervisorTest, LeavesTheHangingOfThoseWhoMayExitToTheOrderedStop) {
  supervisor_.Start(Fake("actor", 0, "exec sleep 60"));
  supervisor_.ExpectExit("actor");
  TimerUntilSaid(&supervisor_, said_, Now());
  EXPECT_THAT(said_, IsEmpty());
}

}  // namespace
}  // namespace shoal::launch
