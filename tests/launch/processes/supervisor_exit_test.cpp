// SPDX-License-Identifier: Apache-2.0
// Processes that leave because they are asked to: retired ones, and all when the run stops.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>

#include "common/base/files.h"
#include "tests/launch/processes/supervisor_fixture.h"
#include "tests/launch/wait_until.h"

namespace shoal::launch {
namespace {

using std::chrono::milliseconds;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST_F(SupervisorTest, ARetiredProcessLeavesForGood) {
  supervisor_.Start(Fake("actor", 0, "sleep 60"));
  supervisor_.Start(
      Fake("actor", 1, "trap 'echo flushed; exit 0' TERM; while :; do sleep 0.01; done"));
  ASSERT_TRUE(WaitUntil([&] { return Starts("actor-1") == 1; }));
  supervisor_.Retire("actor", 1, Now());
  EXPECT_TRUE(PollUntil([&] { return supervisor_.Running("actor") == 1; }));
  EXPECT_EQ(supervisor_.Pid("actor", 1), 0);
  EXPECT_NE(supervisor_.Pid("actor", 0), 0);
  EXPECT_EQ(LastLine(folder_.path() / "actor-1.log"), "flushed");
  EXPECT_EQ(supervisor_.Poll(Now() + std::chrono::hours(1)), std::nullopt);
  EXPECT_EQ(Starts("actor-1"), 1);
  EXPECT_THAT(supervisor_.unclean_exits(), IsEmpty());
}

TEST_F(SupervisorTest, ASuccessorWaitsUntilTheRetiredOneHasLeft) {
  const auto gate = folder_.path() / "gate";
  supervisor_.Start(
      Fake("actor", 0,
           "trap '' TERM; while [ ! -e " + gate.string() + " ]; do sleep 0.01; done; echo left"));
  ASSERT_TRUE(WaitUntil([&] { return Starts("actor-0") == 1; }));
  const pid_t first = supervisor_.Pid("actor", 0);
  supervisor_.Retire("actor", 0, Now());
  supervisor_.Start(Fake("actor", 0, "sleep 60"));
  EXPECT_EQ(supervisor_.Poll(Now()), std::nullopt);
  EXPECT_EQ(supervisor_.Pid("actor", 0), first) << "two sessions would make the same episodes";
  WriteFileAtomically(gate, "");
  EXPECT_TRUE(PollUntil([&] { return Starts("actor-0") == 2; }));
  EXPECT_EQ(supervisor_.Running("actor"), 1);
  EXPECT_EQ(supervisor_.restarts(), 0);
}

TEST_F(SupervisorTest, ARetiredProcessThatStaysIsKilled) {
  supervisor_.Start(Fake("actor", 0, "trap '' TERM; while :; do sleep 0.01; done"));
  ASSERT_TRUE(WaitUntil([&] { return Starts("actor-0") == 1; }));
  const SteadyTime start = Now();
  supervisor_.Retire("actor", 0, start);
  EXPECT_EQ(supervisor_.Poll(start + Supervisor::kRetire - milliseconds(1)), std::nullopt);
  EXPECT_THAT(said_, IsEmpty());
  EXPECT_EQ(supervisor_.Poll(start + Supervisor::kRetire), std::nullopt);
  EXPECT_THAT(said_, Contains(HasSubstr("did not leave within 40 s")));
  EXPECT_TRUE(PollUntil([&] { return supervisor_.Running("actor") == 0; }));
  EXPECT_THAT(supervisor_.unclean_exits(), Contains(HasSubstr("SIGKILL")));
}

TEST_F(SupervisorTest, LetsExpectedExitsBe) {
  supervisor_.Start(Fake("actor", 0, "exit 0"));
  supervisor_.Start(Fake("learner", 0, "exec sleep 60"));
  supervisor_.ExpectExit("actor");
  EXPECT_TRUE(PollUntil([&] { return supervisor_.Running("actor") == 0; }));
  EXPECT_EQ(supervisor_.Running(""), 1);
  EXPECT_THAT(said_, IsEmpty());
  EXPECT_THAT(supervisor_.unclean_exits(), IsEmpty());
}

TEST_F(SupervisorTest, RemembersUncleanExpectedExits) {
  supervisor_.Start(Fake("actor", 0, "echo 3 records left; exit 1"));
  supervisor_.ExpectExit("");
  EXPECT_TRUE(PollUntil([&] { return supervisor_.Running("") == 0; }));
  EXPECT_THAT(supervisor_.unclean_exits(),
              ElementsAre(HasSubstr("actor-0: exit code 1: 3 records left")));
}

TEST_F(SupervisorTest, AProcessThatWaitsForItsRestartWhenTheRunStopsIsAnUncleanExit) {
  ProcessSpec actor = Fake("actor", 0, "exit 1");
  actor.expendable = true;
  const auto died = [this](const char* text) {
    return PollUntil([&] {
      return std::ranges::any_of(
          said_, [&](const std::string& line) { return line.find(text) != std::string::npos; });
    });
  };
  supervisor_.Start(actor);
  ASSERT_TRUE(died("actor-0: exit code 1"));
  supervisor_.Start(Fake("replay", 0, "exit 1"));
  ASSERT_TRUE(died("replay-0: exit code 1"));
  supervisor_.ExpectExit("");
  EXPECT_THAT(supervisor_.unclean_exits(),
              ElementsAre("replay-0: died and is not restarted while stopping"));
}

TEST_F(SupervisorTest, KnowsWhoCouldNotWriteAllOfItsResults) {
  supervisor_.Start(Fake("learner", 0, "echo no room; exit 4"));
  supervisor_.ExpectExit("");
  EXPECT_TRUE(PollUntil([&] { return supervisor_.Running("") == 0; }));
  EXPECT_THAT(supervisor_.unwritten_exits(), ElementsAre("learner-0"));
  EXPECT_THAT(supervisor_.unclean_exits(), IsEmpty());
}

TEST_F(SupervisorTest, AProcessThatIsRetiredBeforeItHasBegunLeftAsItWasTold) {
  supervisor_.Start(Fake("actor", 0, "exec sleep 60"));  // which has no handler of SIGTERM
  supervisor_.Retire("actor", 0, Now());
  EXPECT_TRUE(PollUntil([&] { return supervisor_.Running("") == 0; }));
  EXPECT_THAT(supervisor_.unclean_exits(), IsEmpty());
  EXPECT_THAT(said_, IsEmpty());
}

TEST_F(SupervisorTest, AProcessThatDiesByAnotherSignalThanItWasSentDidNotLeaveInOrder) {
  supervisor_.Start(Fake("actor", 0, "trap 'kill -SEGV $$' TERM; echo ready; sleep 60 & wait"));
  EXPECT_TRUE(WaitUntil(
      [&] { return ReadFile(folder_.path() / "actor-0.log").find("ready") != std::string::npos; }));
  supervisor_.Retire("actor", 0, Now());
  EXPECT_TRUE(PollUntil([&] { return supervisor_.Running("") == 0; }));
  EXPECT_THAT(supervisor_.unclean_exits(), ElementsAre(HasSubstr("killed by SIGSEGV")));
}

TEST_F(SupervisorTest, ForgetsAPendingRestartOfAnExpectedExit) {
  supervisor_.Start(Fake("actor", 0, "exit 1"));
  const SteadyTime late = Now() + std::chrono::hours(1);
  EXPECT_TRUE(WaitUntil([&] { return supervisor_.Poll(late), !said_.empty(); }));
  supervisor_.ExpectExit("actor");
  EXPECT_EQ(supervisor_.Running("actor"), 0);
  supervisor_.Poll(late + std::chrono::hours(1));
  EXPECT_EQ(supervisor_.restarts(), 0);
}

TEST_F(SupervisorTest, SignalsOneRoleOnly) {
  supervisor_.Start(Fake("actor", 0, "exec sleep 60"));
  supervisor_.Start(Fake("learner", 0, "exec sleep 60"));
  supervisor_.ExpectExit("");
  supervisor_.Signal("actor", SIGTERM);
  EXPECT_TRUE(PollUntil([&] { return supervisor_.Running("actor") == 0; }));
  EXPECT_EQ(supervisor_.Running("learner"), 1);
}

}  // namespace
}  // namespace shoal::launch
