// SPDX-License-Identifier: Apache-2.0
#include "launch/run/live_settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"

namespace shoal::launch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Config Running() {
  Config config;
  config.actors = 2;
  config.learner.threads = 1;
  return config;
}

std::string Refusal(LiveSettings& settings, const std::string& assignment) {
  try {
    settings.Assign(assignment, 0);
    return "taken";
  } catch (const Error& e) {
    EXPECT_EQ(e.exit_code(), 2) << e.what();
    return e.what();
  }
}

TEST(LiveSettings, AChangeNamesBothValuesAndHolds) {
  LiveSettings settings(Running());
  const SettingChange change = settings.Assign("replay.samples_per_insert=32.5", 0);
  EXPECT_EQ(change.key, "replay.samples_per_insert");
  EXPECT_EQ(change.from, 64);
  EXPECT_EQ(change.to, 32.5);
  EXPECT_EQ(settings.config().replay.samples_per_insert, Schedule::Constant(32.5));
}

// A number replaces the schedule. The old value is the schedule's at that time.
TEST(LiveSettings, ANumberTakesTheSchedulesPlaceAndAScheduleIsRefused) {
  Config config = Running();
  config.replay.samples_per_insert = Schedule{64, 16, 1000};
  LiveSettings settings(config);
  EXPECT_EQ(Refusal(settings, "replay.samples_per_insert=linear(64,8,1000)"),
            "replay.samples_per_insert=linear(64,8,1000): expected a number; a running run accepts "
            "no schedule");
  const SettingChange change = settings.Assign("replay.samples_per_insert=32", 250);
  EXPECT_EQ(change.from, 52);
  EXPECT_EQ(change.to, 32);
  EXPECT_EQ(settings.config().replay.samples_per_insert, Schedule::Constant(32));
  ControlMessage message;
  settings.AddTo(&message);
  EXPECT_THAT(message.setting_values, ElementsAre(32));
  LiveSettings resumed(config);
  resumed.Restore({{change}});
  EXPECT_EQ(resumed.config().replay.samples_per_insert, Schedule::Constant(32));
}

TEST(LiveSettings, EveryLiveKeyCanBeChanged) {
  LiveSettings settings(Running());
  for (const LiveKey& live : LiveKeys()) {
    EXPECT_FALSE(live.uses.empty()) << live.key;
    if (live.key == "actors") continue;
    EXPECT_EQ(settings.Assign(std::string(live.key) + "=1", 0).to, 1) << live.key;
  }
  EXPECT_EQ(settings.SetActors("5").from, 2);
  EXPECT_EQ(settings.config().actors, 5);
}

TEST(LiveSettings, WhatIsFixedUnknownOrOutOfRangeIsRefusedByName) {
  LiveSettings settings(Running());
  EXPECT_THAT(Refusal(settings, "learner.batch=64"), HasSubstr("learner.batch is fixed"));
  EXPECT_THAT(Refusal(settings, "learner.batch=64"), HasSubstr("eval.interval"));
  EXPECT_THAT(Refusal(settings, "learner.bach=64"), HasSubstr("learner.batch"));
  EXPECT_THAT(Refusal(settings, "eval.interval=0"), HasSubstr("eval.interval"));
  EXPECT_THAT(Refusal(settings, "eval.interval=often"), HasSubstr("often"));
  EXPECT_THAT(Refusal(settings, "eval.interval"), HasSubstr("eval.interval"));
  EXPECT_THAT(Refusal(settings, "actors=3"), HasSubstr("shoal scale"));
  EXPECT_THROW(settings.SetActors("0"), Error);
  EXPECT_THROW(settings.SetActors("1025"), Error);
  EXPECT_THROW(settings.SetActors("many"), Error);
  ControlMessage message;
  settings.AddTo(&message);
  EXPECT_TRUE(message.setting_names.empty());
}

TEST(LiveSettings, ThreadsOfTheLearnerNeedRowsAndALearnerThatCanChangeThem) {
  LiveSettings settings(Running());  // batches of 128
  EXPECT_EQ(settings.Assign("learner.threads=12", 0).to, 12);
  EXPECT_THAT(Refusal(settings, "learner.threads=129"), HasSubstr("rows of its own"));
  EXPECT_THAT(Refusal(settings, "learner.threads=0"), HasSubstr("at least 1"));
  EXPECT_EQ(settings.config().learner.threads, 12);
  Config on_policy = Running();
  on_policy.learner.algorithm = "ppo";
  LiveSettings rollouts(on_policy);
  EXPECT_THAT(Refusal(rollouts, "learner.threads=2"), HasSubstr("fixed for the run"));
}

TEST(LiveSettings, InLockstepNothingCanBeChanged) {
  Config config = Running();
  config.actors = 1;
  config.lockstep = true;
  LiveSettings settings(config);
  EXPECT_THAT(Refusal(settings, "env_steps=5"), HasSubstr("lockstep"));
}

TEST(LiveSettings, ProcessesAreToldThePresentValueOfEachChangedKeyOnce) {
  LiveSettings settings(Running());
  settings.Assign("eval.interval=100", 0);
  settings.SetActors("3");
  settings.Assign("eval.interval=200", 0);
  ControlMessage message;
  settings.AddTo(&message);
  EXPECT_THAT(message.setting_names, ElementsAre("eval.interval", "actors"));
  EXPECT_THAT(message.setting_values, ElementsAre(200, 3));
}

TEST(LiveSettings, AResumedRunGoesOnWithWhatWasChanged) {
  LiveSettings before(Running());
  std::vector<SettingChange> changes{before.Assign("stop.success=0.5", 0), before.SetActors("4"),
                                     before.Assign("stop.success=0.75", 0)};
  LiveSettings after(Running());
  after.Restore(changes);
  EXPECT_EQ(after.config().stop.success, 0.75);
  EXPECT_EQ(after.config().actors, 4);
}

}  // namespace
}  // namespace shoal::launch
