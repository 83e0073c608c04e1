// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/supervisor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>

#include "common/base/files.h"
#include "tests/launch/wait_until.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Matches;

constexpr RestartLimits kQuick{.restarts = 3,
                               .window = std::chrono::seconds(60),
                               .first_delay = milliseconds(1),
                               .longest_delay = milliseconds(4)};

class SupervisorTest : public ::testing::Test {
 protected:
  ProcessSpec Fake(const std::string& role, int id, const std::string& script) const {
    ProcessSpec spec;
    spec.role = role;
    spec.id = id;
    spec.command = {"/bin/sh", "-c", "echo started; " + script};
    spec.output = folder_.path() / (spec.Name() + ".log");
    return spec;
  }
  int Starts(const std::string& name) const {
    const auto file = folder_.path() / (name + ".log");
    if (!std::filesystem::exists(file)) return 0;
    const std::string text = ReadFile(file);
    int starts = 0;
    for (size_t at = text.find("started\n"); at != std::string::npos;
         at = text.find("started\n", at + 1)) {
      ++starts;
    }
    return starts;
  }
  // Polls until the run fails; its reason.
  std::string WaitForFailure() {
    std::optional<std::string> failure;
    EXPECT_TRUE(WaitUntil([&] { return (failure = supervisor_.Poll(Now())).has_value(); }));
    return failure.value_or("");
  }
  bool PollUntil(const std::function<bool()>& condition) {
    return WaitUntil([&] {
      EXPECT_EQ(supervisor_.Poll(Now()), std::nullopt);
      return condition();
    });
  }

  TemporaryFolder folder_;
  std::vector<std::string> said_;
  Supervisor supervisor_{kQuick, HangLimits(),
                         [this](const std::string& line) { said_.push_back(line); }};
};

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

TEST_F(SupervisorTest, FailsTheRunWhenAProcessDiesTooOften) {
  supervisor_.Start(Fake("learner", 0, "echo no luck; exit 1"));
  EXPECT_THAT(WaitForFailure(),
              AllOf(HasSubstr("learner-0: exit code 1: no luck"), HasSubstr("more than 3 times")));
  EXPECT_EQ(Starts("learner-0"), 4) << "the first start and three restarts";
}

TEST_F(SupervisorTest, AnExpendableProcessIsTriedForAsLongAsTheRunLasts) {
  ProcessSpec actor = Fake("actor", 1, "echo no luck; exit 1");
  actor.expendable = true;
  supervisor_.Start(Fake("learner", 0, "exec sleep 60"));
  supervisor_.Start(actor);
  SteadyTime now = Now();
  for (int start = 1; start <= 9; ++start) {
    EXPECT_TRUE(WaitUntil([&] {
      EXPECT_EQ(supervisor_.Poll(now), std::nullopt);
      return supervisor_.Pid("actor", 1) == 0 && Starts("actor-1") == start;
    })) << start;
    const RoleStanding standing = supervisor_.Standing("actor", now);
    EXPECT_EQ(standing.processes, 1);
    EXPECT_EQ(standing.working, 0);
    ASSERT_EQ(standing.down.size(), 1u);
    const DownProcess& down = standing.down[0];
    EXPECT_EQ(down.name, "actor-1");
    EXPECT_EQ(down.reason, "exit code 1: no luck");
    EXPECT_EQ(down.deaths, start);
    EXPECT_EQ(down.hopeless, start <= kQuick.restarts
                                 ? ""
                                 : "exit code 1: no luck (died more than 3 times within 60 s)");
    ASSERT_TRUE(down.restart_in);
    // 0.2 s, 0.4 s, ... 51.2 s, in whole seconds.
    EXPECT_EQ(down.restart_in->count(), (200 * (1 << (start - 1)) + 999) / 1000);
    now += *down.restart_in;
  }
  EXPECT_THAT(said_, ElementsAre(HasSubstr("actor-1: exit code 1: no luck; restart in 0.2 s"),
                                 HasSubstr("restart in 0.4 s (death 2 in a row"),
                                 HasSubstr("restart in 1.6 s (death 4 in a row"),
                                 HasSubstr("restart in 25.6 s (death 8 in a row")));
  EXPECT_EQ(supervisor_.DescribeDeaths(), "actor-1 9 times (last: exit code 1: no luck)");
  EXPECT_NE(supervisor_.Pid("learner", 0), 0);
}

TEST_F(SupervisorTest, AnExpendableProcessWorksAgainOnceItHasReportedForAWhile) {
  ProcessSpec actor = Fake(
      "actor", 0,
      "[ $(wc -l < " + folder_.path().string() + "/actor-0.log) -ge 2 ] && exec sleep 60; exit 1");
  actor.expendable = true;
  supervisor_.Start(actor);
  EXPECT_TRUE(PollUntil([&] { return Starts("actor-0") == 2; }));
  const SteadyTime start = Now();
  const auto down = [&](SteadyTime now) { return supervisor_.Standing("actor", now).down; };
  ASSERT_EQ(down(start).size(), 1u);
  EXPECT_EQ(down(start)[0].restart_in, std::nullopt) << "it is being tried";
  supervisor_.Heard("actor", 0, supervisor_.Pid("actor", 0), start);
  EXPECT_EQ(down(start + Supervisor::kSettled - milliseconds(1)).size(), 1u);
  EXPECT_THAT(down(start + Supervisor::kSettled), IsEmpty());
  EXPECT_EQ(supervisor_.Standing("actor", start + Supervisor::kSettled).working, 1);
}

TEST_F(SupervisorTest, AnExpendableProcessThatRefusesItsConfigurationIsHopelessAtOnce) {
  ProcessSpec actor = Fake("actor", 0, "echo bad batch; exit 2");
  actor.expendable = true;
  supervisor_.Start(actor);
  const SteadyTime late = Now() + std::chrono::hours(1);
  EXPECT_TRUE(WaitUntil([&] {
    EXPECT_EQ(supervisor_.Poll(late), std::nullopt);
    return !said_.empty();
  }));
  EXPECT_EQ(supervisor_.Standing("actor", late).down.at(0).hopeless, "exit code 2: bad batch");
}

TEST_F(SupervisorTest, AnExpendableProcessThatHasWorkedIsHopelessNoMore) {
  ProcessSpec actor = Fake("actor", 0,
                           "[ $(wc -l < " + folder_.path().string() +
                               "/actor-0.log) -ge 2 ] && exec sleep 60; echo bad batch; exit 2");
  actor.expendable = true;
  supervisor_.Start(actor);
  ASSERT_TRUE(PollUntil([&] { return Starts("actor-0") == 2; }));
  const SteadyTime start = Now(), settled = start + Supervisor::kSettled;
  const pid_t pid = supervisor_.Pid("actor", 0);
  supervisor_.Heard("actor", 0, pid, start);
  EXPECT_EQ(supervisor_.Standing("actor", start).down.at(0).hopeless, "exit code 2: bad batch");
  kill(pid, SIGKILL);
  ASSERT_TRUE(
      WaitUntil([&] { return supervisor_.Poll(settled), supervisor_.Pid("actor", 0) != pid; }));
  EXPECT_THAT(supervisor_.Standing("actor", settled).down.at(0).reason, HasSubstr("SIGKILL"));
  EXPECT_THAT(supervisor_.Standing("actor", settled).down.at(0).hopeless, IsEmpty());
}

TEST_F(SupervisorTest, ANonFiniteNumberOfAnExpendableProcessEndsTheRun) {
  ProcessSpec actor = Fake("actor", 0, "echo the simulation diverged; exit 3");
  actor.expendable = true;
  supervisor_.Start(actor);
  EXPECT_THAT(WaitForFailure(), HasSubstr("actor-0: exit code 3: the simulation diverged"));
}

TEST_F(SupervisorTest, ALostConnectionToAnExpendableProcessIsTriedAgainWithinTenSeconds) {
  ProcessSpec actor = Fake("actor", 0, "exit 255");
  actor.expendable = actor.elsewhere = true;
  supervisor_.Start(actor);
  SteadyTime now = Now();
  for (int start = 1; start <= 9; ++start) {
    ASSERT_TRUE(WaitUntil([&] {
      EXPECT_EQ(supervisor_.Poll(now), std::nullopt);
      return supervisor_.Pid("actor", 0) == 0 && Starts("actor-0") == start;
    }));
    now += std::chrono::seconds(10);
  }
  EXPECT_THAT(supervisor_.Standing("actor", now).down.at(0).hopeless, IsEmpty())
      << "the host may come back";
}

TEST_F(SupervisorTest, AProcessThatMayExitIsNotMissed) {
  ProcessSpec actor = Fake("actor", 0, "exit 1");
  actor.expendable = true;
  supervisor_.Start(actor);
  const SteadyTime late = Now() + std::chrono::hours(1);
  EXPECT_TRUE(WaitUntil([&] { return supervisor_.Poll(late), !said_.empty(); }));
  supervisor_.ExpectExit("actor");
  EXPECT_EQ(supervisor_.Standing("actor", late).processes, 0);
  EXPECT_THAT(supervisor_.Standing("actor", late).down, IsEmpty());
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

// Process numbers of two hosts have nothing to do with each other: here those of the actor over
// there, whose child on this side is the remote shell, are those of the actor here.
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
              ElementsAre("replay-0: had died, and is not started again while stopping"));
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
