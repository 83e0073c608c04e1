// SPDX-License-Identifier: Apache-2.0
#include "launch/run/run_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/dds/bus.h"
#include "launch/watch/message_inbox.h"
#include "tests/launch/wait_until.h"

namespace shoal::launch {
namespace {

using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::IsEmpty;

CommandMessage Command(uint64_t client, uint64_t request, const std::string& verb) {
  return {.client = client, .request = request, .verb = verb};
}

// A server with one client on a bus of their own, where a message arrives before its Write returns.
class RunServerTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(WaitUntil(
        [&] { return commands_.Matched() > 0 && replies_.Matched() > 0 && views_.Matched() > 0; }));
  }

  ClusterAddress address_;
  std::unique_ptr<dds::Bus> bus_ = dds::ClaimDomain(TransportConfig{}, &address_);
  std::vector<RunViewMessage> shown_;
  RunServer server_{*bus_, "run", [this](const RunViewMessage& view) { shown_.push_back(view); }};
  link::Writer<CommandMessage> commands_{*bus_};
  MessageInbox<ReplyMessage> reply_inbox_{100};
  link::Reader<ReplyMessage> replies_{
      *bus_, [this](const ReplyMessage& reply) { reply_inbox_.Put(reply); }};
  MessageInbox<RunViewMessage> view_inbox_{100};
  link::Reader<RunViewMessage> views_{
      *bus_, [this](const RunViewMessage& view) { view_inbox_.Put(view); }};
};

TEST_F(RunServerTest, ARepeatedCommandIsAnsweredAgainAndNotGivenOutTwice) {
  const auto answered = Field(&ReplyMessage::text, "stopping");
  commands_.Write(Command(5, 1, "stop"));
  commands_.Write(Command(5, 1, "stop"));
  EXPECT_THAT(server_.TakeCommands(), ElementsAre(Field(&CommandMessage::verb, "stop")));
  server_.Answer({.client = 5, .request = 1, .accepted = true, .text = "stopping"});
  EXPECT_THAT(reply_inbox_.TakeAll(), ElementsAre(answered));

  commands_.Write(Command(5, 1, "stop"));
  EXPECT_THAT(server_.TakeCommands(), IsEmpty());
  EXPECT_THAT(reply_inbox_.TakeAll(), ElementsAre(answered));

  commands_.Write(Command(5, 2, "scale"));
  commands_.Write(Command(6, 1, "set"));
  EXPECT_THAT(server_.TakeCommands(), ElementsAre(Field(&CommandMessage::verb, "scale"),
                                                  Field(&CommandMessage::verb, "set")));
}

TEST_F(RunServerTest, ShowsTheRunWithItsLastEvents) {
  for (size_t i = 1; i <= RunServer::kEvents + 1; ++i) {
    server_.AddEvent("event " + std::to_string(i));
  }
  const SteadyTime now = Now();
  EXPECT_TRUE(server_.Due(now));
  server_.Show({.run = "another", .state = "running", .env_steps = 12}, now);
  EXPECT_FALSE(server_.Due(now));
  EXPECT_TRUE(server_.Due(now + RunServer::kPeriod));
  const std::vector<RunViewMessage> views = view_inbox_.TakeAll();
  ASSERT_EQ(views.size(), 1u);
  EXPECT_EQ(views[0].run, "run");
  EXPECT_EQ(views[0].env_steps, 12u);
  ASSERT_EQ(views[0].events.size(), RunServer::kEvents);
  EXPECT_EQ(views[0].events.front().text, "event 2");
  ASSERT_EQ(shown_.size(), 1u);
  EXPECT_EQ(shown_[0].state, "running");
}

TEST_F(RunServerTest, TheLastViewHoldsTheCoordinatorAloneWithItsExitCode) {
  RunViewMessage view{.state = "running"};
  for (const char* role : {"actor", "coordinator", "replay"}) {
    view.processes.emplace_back();
    view.processes.back().role = role;
  }
  server_.Show(view, Now());
  server_.ShowEnd(3);
  ASSERT_EQ(shown_.size(), 2u);
  EXPECT_EQ(shown_[1].state, "ended");
  ASSERT_EQ(shown_[1].processes.size(), 1u);
  const MetricsMessage& coordinator = shown_[1].processes[0];
  EXPECT_EQ(coordinator.role, "coordinator");
  EXPECT_THAT(coordinator.names, ElementsAre("exit_code"));
  EXPECT_THAT(coordinator.values, ElementsAre(3));
}

}  // namespace
}  // namespace shoal::launch
