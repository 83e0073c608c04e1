// SPDX-License-Identifier: Apache-2.0
#include "launch/run/command_handler.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"

namespace shoal::launch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class CommandHandlerTest : public ::testing::Test {
 protected:
  ReplyMessage Handle(const std::string& verb, const std::vector<std::string>& arguments) {
    return handler_.Handle({.client = 7, .request = 3, .verb = verb, .arguments = arguments});
  }
  static Config Running() {
    Config config;
    config.actors = 2;
    config.learner.threads = 1;
    return config;
  }

  bool running_ = true;
  std::vector<std::string> done_;
  LiveSettings settings_{Running()};
  CommandHandler handler_{
      settings_,
      {.running = [this] { return running_; },
       .env_steps = [] { return uint64_t{500}; },
       .stop = [this] { done_.push_back("stop"); },
       .scale = [this](int from, int to) { done_.push_back(fmt::format("{}->{}", from, to)); },
       .note = [this](const SettingChange& c) { done_.push_back("note " + c.key); },
       .check =
           [](const Config& config) {
             if (config.learner.threads > 4) throw UsageError("this machine has 4 cores");
           }}};
};

TEST_F(CommandHandlerTest, AChangeIsNotedAndAnsweredWithBothValues) {
  const ReplyMessage reply = Handle("set", {"eval.interval=500"});
  EXPECT_TRUE(reply.accepted);
  EXPECT_EQ(reply.text, "eval.interval: 2500 -> 500");
  EXPECT_EQ(reply.key, "eval.interval");
  EXPECT_EQ(reply.from, 2500);
  EXPECT_EQ(reply.to, 500);
  EXPECT_EQ(reply.client, 7u);
  EXPECT_EQ(reply.request, 3u);
  EXPECT_THAT(done_, ElementsAre("note eval.interval"));
}

TEST_F(CommandHandlerTest, OfSeveralAssignmentsAllAreMadeOrNone) {
  const ReplyMessage refused = Handle("set", {"eval.interval=500", "learner.batch=3"});
  EXPECT_FALSE(refused.accepted);
  EXPECT_EQ(settings_.config().eval.interval, 2500);
  EXPECT_THAT(done_, IsEmpty());
  const ReplyMessage reply = Handle("set", {"eval.interval=500", "stop.success=2"});
  EXPECT_TRUE(reply.accepted);
  EXPECT_THAT(reply.text, HasSubstr("eval.interval: 2500 -> 500; stop.success: "));
  EXPECT_EQ(settings_.config().eval.interval, 500);
  EXPECT_EQ(settings_.config().stop.success, 2);
  EXPECT_THAT(done_, ElementsAre("note eval.interval", "note stop.success"));
}

TEST_F(CommandHandlerTest, WhatTheMachineCannotDoChangesNothing) {
  const ReplyMessage refused = Handle("set", {"eval.interval=500", "learner.threads=5"});
  EXPECT_FALSE(refused.accepted);
  EXPECT_EQ(refused.text, "this machine has 4 cores");
  EXPECT_EQ(settings_.config().eval.interval, 2500);
  EXPECT_THAT(done_, IsEmpty());
  EXPECT_TRUE(Handle("set", {"learner.threads=4"}).accepted);
}

TEST_F(CommandHandlerTest, OfAScheduleTheFormerValueIsThatOfTheEnvStepsSoFar) {
  Config config = Running();
  config.replay.samples_per_insert = Schedule{64, 16, 1000};
  settings_ = LiveSettings(config);
  EXPECT_EQ(Handle("set", {"replay.samples_per_insert=8"}).text,
            "replay.samples_per_insert: 40 -> 8");
}

TEST_F(CommandHandlerTest, ScalingStartsOrEndsActorsAndIsNoted) {
  EXPECT_TRUE(Handle("scale", {"5"}).accepted);
  EXPECT_TRUE(Handle("scale", {"1"}).accepted);
  EXPECT_THAT(done_, ElementsAre("2->5", "note actors", "5->1", "note actors"));
}

TEST_F(CommandHandlerTest, WhatIsRefusedChangesNothingAndSaysWhy) {
  for (const auto& [verb, arguments] :
       std::vector<std::pair<std::string, std::vector<std::string>>>{
           {"set", {"learner.batch=3"}}, {"set", {}}, {"scale", {"none"}}, {"dance", {}}}) {
    const ReplyMessage reply = Handle(verb, arguments);
    EXPECT_FALSE(reply.accepted) << verb;
    EXPECT_FALSE(reply.text.empty()) << verb;
  }
  EXPECT_THAT(Handle("dance", {}).text, HasSubstr("dance"));
  EXPECT_THAT(done_, IsEmpty());
}

TEST_F(CommandHandlerTest, AScaleThatFailsChangesNothing) {
  CommandHandler handler(settings_,
                         {.running = [] { return true; },
                          .env_steps = [] { return uint64_t{0}; },
                          .stop = [] {},
                          .scale = [](int, int) { throw RuntimeError("no room"); },
                          .note = [this](const SettingChange&) { done_.push_back("note"); },
                          .check = [](const Config&) {}});
  const ReplyMessage reply =
      handler.Handle({.client = 7, .request = 3, .verb = "scale", .arguments = {"5"}});
  EXPECT_FALSE(reply.accepted);
  EXPECT_EQ(reply.text, "no room");
  EXPECT_EQ(settings_.config().actors, 2);
  EXPECT_THAT(done_, IsEmpty());
}

TEST_F(CommandHandlerTest, ARunThatIsStoppingOnlyConfirmsThat) {
  running_ = false;
  EXPECT_FALSE(Handle("set", {"eval.interval=500"}).accepted);
  EXPECT_FALSE(Handle("scale", {"3"}).accepted);
  EXPECT_TRUE(Handle("stop", {}).accepted);
  EXPECT_THAT(done_, IsEmpty());
}

}  // namespace
}  // namespace shoal::launch
