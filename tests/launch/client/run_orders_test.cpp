// SPDX-License-Identifier: Apache-2.0
#include "launch/client/run_orders.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/launch/client/played_client.h"

namespace shoal::launch {
namespace {

using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Ge;
using ::testing::HasSubstr;
using ::testing::Lt;

int Stop(RunClient& client, const Say& say) { return StopRun(client, /*folder=*/"", say); }

TEST(StopRun, ReturnsTheRunsExitCodeAndSaysItsEvents) {
  PlayedCoordinator coordinator;
  const PlayedClient played = PlayClient(
      [&](RunServer& server) {
        server.AddEvent("before");
        coordinator.Serve(server, seconds(3));
        server.AddEvent("run ended");
        server.ShowEnd(4);
      },
      Stop);
  EXPECT_EQ(played.error, "");
  EXPECT_EQ(played.code, 4);
  EXPECT_THAT(played.lines, ElementsAre("done", "run ended"));
}

TEST(StopRun, SaysAfterFifteenSecondsThatTheCoordinatorIsSilent) {
  PlayedCoordinator coordinator;
  const PlayedClient played =
      PlayClient([&](RunServer& server) { coordinator.Serve(server, seconds(3)); }, Stop);
  EXPECT_EQ(played.error,
            "accepted, but the run's coordinator has been silent for 15 s: see shoal runs");
  EXPECT_EQ(played.code, 1);
  EXPECT_THAT(played.seconds, AllOf(Ge(17), Lt(19)));
}

TEST(StopRun, DoesNotWaitForAnotherCoordinatorThatHasResumedTheRun) {
  PlayedCoordinator first{.uptime = 100}, second;
  const PlayedClient played = PlayClient(
      [&](RunServer& server) {
        first.Serve(server, seconds(3));
        SleepFor(seconds(10));
        second.Serve(server, seconds(60));
      },
      Stop);
  EXPECT_THAT(played.error, HasSubstr("another one has resumed the run: see shoal runs"));
  EXPECT_EQ(played.code, 1);
  EXPECT_THAT(played.seconds, AllOf(Ge(12), Lt(15)));
  EXPECT_EQ(second.commands, 0);
}

TEST(SetKeys, WaitsUntilTheValueIsInForceTenSecondsAtMost) {
  const auto set = [](RunClient& client, const Say& say) {
    return SetKeys(client, {"learner.weights_period=5"}, say);
  };
  PlayedCoordinator coordinator;
  coordinator.processes = {ReportOf("learner", 0, "weights_period", 1)};
  const PlayedClient late =
      PlayClient([&](RunServer& server) { coordinator.Serve(server, seconds(30)); }, set);
  EXPECT_THAT(late.error, HasSubstr("not in force at every process within 10 s"));
  EXPECT_THAT(late.seconds, AllOf(Ge(10), Lt(12)));
  const PlayedClient in_force = PlayClient(
      [&](RunServer& server) {
        coordinator.Serve(server, seconds(3));
        coordinator.processes[0].values = {5};
        coordinator.Serve(server, seconds(10));
      },
      set);
  EXPECT_THAT(in_force.lines, ElementsAre("done", "in force: learner-0 5"));
  EXPECT_THAT(in_force.seconds, AllOf(Ge(3), Lt(5)));
}

TEST(ScaleActors, WaitsUntilSoManyReportOneMinuteAtMost) {
  const auto scale = [](RunClient& client, const Say& say) { return ScaleActors(client, 2, say); };
  PlayedCoordinator coordinator;
  coordinator.processes = {ReportOf("actor", 0, "env_steps", 1),
                           ReportOf("actor", 1, "env_steps", 1)};
  coordinator.processes[1].state = "silent";
  const PlayedClient late =
      PlayClient([&](RunServer& server) { coordinator.Serve(server, seconds(90)); }, scale);
  EXPECT_THAT(late.error, HasSubstr("2 actors have not reported within 60 s"));
  EXPECT_THAT(late.seconds, AllOf(Ge(60), Lt(62)));
  coordinator.processes[1].state = "running";
  const PlayedClient there =
      PlayClient([&](RunServer& server) { coordinator.Serve(server, seconds(9)); }, scale);
  EXPECT_THAT(there.lines, ElementsAre("done", "2 actor(s) report"));
  coordinator.state = "stopping";
  const PlayedClient ending =
      PlayClient([&](RunServer& server) { coordinator.Serve(server, seconds(9)); }, scale);
  EXPECT_THAT(ending.lines, ElementsAre("done", "the run is ending"));
}

}  // namespace
}  // namespace shoal::launch
