// SPDX-License-Identifier: Apache-2.0
#include "common/config/live_values.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <string>

namespace shoal {
namespace {

// The values of a configuration after these changes.
LiveValues After(const Config& config, const std::map<std::string, double>& changes) {
  const SteadyTime start = Now();
  ControlState control(start);
  ControlMessage message;
  message.epoch = 1;
  for (const auto& [key, value] : changes) {
    message.setting_names.push_back(key);
    message.setting_values.push_back(value);
  }
  control.OnMessage(message, start);
  return LiveValuesOf(config, control);
}

Config Configured() {
  Config config;
  config.env_steps = 5'000'000'000;
  config.actors = 3;
  config.learner.weights_period = 7;
  config.eval.interval = 900;
  config.replay.samples_per_insert = Schedule{64, 16, 1000};
  return config;
}

TEST(LiveValues, AreThoseOfTheConfigurationWithoutAChange) {
  const LiveValues values = After(Configured(), {});
  EXPECT_EQ(values.env_steps, 5'000'000'000u);
  EXPECT_EQ(values.actors, 3);
  EXPECT_EQ(values.weights_period, 7u);
  EXPECT_EQ(values.eval_interval, 900u);
  EXPECT_EQ(values.samples_per_insert, (Schedule{64, 16, 1000}));
  EXPECT_EQ(values.learner_threads, std::nullopt);
}

TEST(LiveValues, AChangeReplacesOneValueAndANumberTheSchedule) {
  LiveValues expected = After(Configured(), {});
  expected.samples_per_insert = Schedule::Constant(8);
  expected.actors = 5;
  EXPECT_EQ(After(Configured(), {{"replay.samples_per_insert", 8}, {"actors", 5}}), expected);
  const LiveValues all = After(Configured(), {{"env_steps", 100},
                                              {"learner.weights_period", 2},
                                              {"eval.interval", 50},
                                              {"learner.threads", 4}});
  EXPECT_EQ(all.env_steps, 100u);
  EXPECT_EQ(all.weights_period, 2u);
  EXPECT_EQ(all.eval_interval, 50u);
  EXPECT_EQ(all.learner_threads, 4);
}

// A foreign program on an open network may send any number.
TEST(LiveValues, PeriodsOfZeroAreIgnoredAndLargeNumbersFit) {
  const LiveValues values = After(
      Configured(),
      {{"learner.weights_period", 0}, {"eval.interval", 0.5}, {"actors", 1e300}, {"batch", 1}});
  EXPECT_EQ(values.weights_period, 7u);
  EXPECT_EQ(values.eval_interval, 900u);
  EXPECT_EQ(values.actors, std::numeric_limits<int>::max());
}

}  // namespace
}  // namespace shoal
