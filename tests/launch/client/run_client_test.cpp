// SPDX-License-Identifier: Apache-2.0
#include "launch/client/run_client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/launch/client/played_client.h"

namespace shoal::launch {
namespace {

using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::Ge;
using ::testing::HasSubstr;
using ::testing::Lt;

TEST(RunClient, ACoordinatorThatDoesNotAnswerIsNamedAfterFiveSeconds) {
  const PlayedClient view = PlayClient([](RunServer&) { SleepFor(seconds(20)); },
                                       [](RunClient& client, const auto&) {
                                         client.FirstView();
                                         return 0;
                                       });
  EXPECT_EQ(view.error,
            "run 'run': its coordinator at here:1 did not answer within 5 s; it may be paused "
            "(Ctrl-Z) or about to end: see shoal runs");
  EXPECT_THAT(view.seconds, AllOf(Ge(5), Lt(5.2)));
  const PlayedClient order = PlayClient([](RunServer&) { SleepFor(seconds(20)); },
                                        [](RunClient& client, const auto&) {
                                          client.Order("stop", {});
                                          return 0;
                                        });
  EXPECT_THAT(order.error, HasSubstr("at here:1 did not answer the command within 5 s"));
  EXPECT_THAT(order.seconds, AllOf(Ge(5), Lt(5.2)));
}

TEST(RunClient, ACommandThatIsAnsweredLateIsCarriedOutOnce) {
  PlayedCoordinator coordinator;
  const PlayedClient played = PlayClient(
      [&](RunServer& server) {
        SleepFor(seconds(3));  // the client has sent it six times
        coordinator.Serve(server, seconds(3));
      },
      [](RunClient& client, const auto& say) {
        say(client.Order("stop", {}).text);
        return 0;
      });
  EXPECT_EQ(played.error, "");
  EXPECT_THAT(played.lines, testing::ElementsAre("done"));
  EXPECT_EQ(coordinator.commands, 1);
}

TEST(RunClient, ARefusalIsAnErrorWithItsReason) {
  PlayedCoordinator coordinator{.accepts = false, .text = "no"};
  const PlayedClient played =
      PlayClient([&](RunServer& server) { coordinator.Serve(server, seconds(5)); },
                 [](RunClient& client, const auto&) {
                   client.Order("stop", {});
                   return 0;
                 });
  EXPECT_EQ(played.error, "refused: no");
  EXPECT_EQ(played.code, 1);
}

TEST(SameCoordinator, IsNotOneThatHasJustBegun) {
  const auto at = [](double uptime) {
    RunViewMessage view;
    view.processes = {ReportOf("learner", 0, "uptime_seconds", 0),
                      ReportOf("coordinator", 0, "uptime_seconds", uptime)};
    return view;
  };
  SameCoordinator coordinator;
  EXPECT_TRUE(coordinator.Take(at(12)));
  EXPECT_TRUE(coordinator.Take(at(13)));
  EXPECT_TRUE(coordinator.Take(RunViewMessage()));
  EXPECT_TRUE(coordinator.Take(at(13)));
  EXPECT_FALSE(coordinator.Take(at(1)));
  EXPECT_TRUE(coordinator.Take(at(2)));
}

}  // namespace
}  // namespace shoal::launch
