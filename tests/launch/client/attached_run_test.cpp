// SPDX-License-Identifier: Apache-2.0
#include "launch/client/attached_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/launch/client/played_client.h"

namespace shoal::launch {
namespace {

using std::chrono::seconds;
using ::testing::ElementsAre;

int Attach(RunClient& client, const std::function<void(const std::string&)>& say) {
  Progress progress("", say, /*plain=*/true);
  return ShowAttached(client, progress);
}

TEST(ShowAttached, SaysEachEventOnceAndReturnsTheRunsExitCode) {
  PlayedCoordinator coordinator;
  const PlayedClient played = PlayClient(
      [&](RunServer& server) {
        server.AddEvent("first");
        coordinator.Serve(server, seconds(3));
        server.AddEvent("second");
        coordinator.uptime = 3;
        coordinator.Serve(server, seconds(3));
        server.ShowEnd(4);
      },
      Attach);
  EXPECT_THAT(played.lines, ElementsAre("first", "second"));
  EXPECT_EQ(played.code, 4);
}

TEST(ShowAttached, ASilentCoordinatorIsNamedAfterFifteenSeconds) {
  PlayedCoordinator coordinator;
  const PlayedClient played =
      PlayClient([&](RunServer& server) { coordinator.Serve(server, seconds(3)); }, Attach);
  EXPECT_EQ(played.error, "run 'run': its coordinator has been silent for 15 s");
}

}  // namespace
}  // namespace shoal::launch
