// SPDX-License-Identifier: Apache-2.0
// Processes that die are restarted, up to a limit.
#include "launch/processes/supervisor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "tests/launch/processes/supervisor_fixture.h"
#include "tests/launch/wait_until.h"

namespace shoal::launch {
namespace {

using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST_F(SupervisorTest, GoesOnTryingToReachAProcessElsewhere) {
  ProcessSpec lost = Fake("actor", 0, "exit 255"), here = Fake("actor", 1, "exit 255");
  lost.elsewhere = true;
  supervisor_.Start(lost);
  EXPECT_TRUE(PollUntil([&] { return Starts("actor-0") > kQuick.restarts + 2; }));
  supervisor_.Start(here);
  EXPECT_THAT(WaitForFailure(), HasSubstr("actor-1"));
}

TEST_F(SupervisorTest, RestartsWhatDiesAndSaysWhy) {
  supervisor_.Start(Fake("actor", 1,
                         "if [ -e " + folder_.path().string() +
                             "/again ]; then sleep 60; fi; touch " + folder_.path().string() +
                             "/again; echo oops; exit 9"));
  EXPECT_TRUE(PollUntil([&] { return Starts("actor-1") == 2; }));
  EXPECT_EQ(supervisor_.restarts(), 1);
  EXPECT_EQ(supervisor_.Running("actor"), 1);
  EXPECT_THAT(said_,
              ElementsAre(AllOf(HasSubstr("actor-1: exit code 9: oops"), HasSubstr("restart in"))));
}

TEST_F(SupervisorTest, AKilledProcessIsNotSaidToHaveDiedOfWhatItToldLast) {
  supervisor_.Start(Fake("learner", 0,
                         "echo 2026-01-31 12:00:00.000 learner-0 info: session 7; echo "
                         "> " +
                             folder_.path().string() + "/told; exec sleep 60"));
  ASSERT_TRUE(PollUntil([&] { return std::filesystem::exists(folder_.path() / "told"); }));
  kill(supervisor_.Pid("learner", 0), SIGKILL);
  ASSERT_TRUE(PollUntil([&] { return !said_.empty(); }));
  EXPECT_THAT(said_[0], ::testing::Not(HasSubstr("session 7")));
  EXPECT_THAT(said_[0], HasSubstr("learner-0: killed by SIGKILL"));
}

TEST_F(SupervisorTest, RestartsAProcessThatLeavesWithoutBeingAsked) {
  supervisor_.Start(Fake(
      "replay", 0,
      "[ $(wc -l < " + folder_.path().string() + "/replay-0.log) -ge 2 ] && sleep 60; exit 0"));
  EXPECT_TRUE(PollUntil([&] { return Starts("replay-0") == 2; }));
}

TEST_F(SupervisorTest, FailsTheRunWhenAProcessDiesTooOften) {
  supervisor_.Start(Fake("learner", 0, "echo no luck; exit 1"));
  EXPECT_THAT(WaitForFailure(),
              AllOf(HasSubstr("learner-0: exit code 1: no luck"), HasSubstr("more than 3 times")));
  EXPECT_EQ(Starts("learner-0"), 4) << "the first start and three restarts";
}

TEST_F(SupervisorTest, WaitsForTheBackOffBeforeARestart) {
  supervisor_.Start(Fake("actor", 0, "kill -9 $$"));
  const SteadyTime late = Now() + std::chrono::hours(1);
  EXPECT_TRUE(WaitUntil([&] { return supervisor_.Poll(late), !said_.empty(); }));
  EXPECT_EQ(supervisor_.Poll(late), std::nullopt);
  EXPECT_EQ(supervisor_.restarts(), 0);
  EXPECT_EQ(supervisor_.Poll(late + milliseconds(1)), std::nullopt);
  EXPECT_EQ(supervisor_.restarts(), 1);
}

TEST_F(SupervisorTest, DoesNotRestartARefusedConfiguration) {
  supervisor_.Start(Fake("learner", 0, "echo bad batch; exit 2"));
  EXPECT_THAT(WaitForFailure(), HasSubstr("learner-0: exit code 2: bad batch"));
  EXPECT_EQ(Starts("learner-0"), 1);
}

TEST_F(SupervisorTest, DoesNotRestartAfterANonFiniteNumber) {
  supervisor_.Start(Fake("actor", 0, "echo the simulation diverged; exit 3"));
  EXPECT_THAT(WaitForFailure(), HasSubstr("actor-0: exit code 3: the simulation diverged"));
  EXPECT_EQ(Starts("actor-0"), 1);
}

}  // namespace
}  // namespace shoal::launch
