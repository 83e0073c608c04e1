// SPDX-License-Identifier: Apache-2.0
// Processes without which the run goes on (ProcessSpec::expendable).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "tests/launch/processes/supervisor_fixture.h"
#include "tests/launch/wait_until.h"

namespace shoal::launch {
namespace {

using std::chrono::milliseconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

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

}  // namespace
}  // namespace shoal::launch
