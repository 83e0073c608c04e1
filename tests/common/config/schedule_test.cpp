// SPDX-License-Identifier: Apache-2.0
#include "common/config/schedule.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/random.h"
#include "common/config/config_io.h"

namespace shoal {
namespace {

TEST(Schedule, AConstantStaysAndALineEndsAtItsEnd) {
  const Schedule constant = Schedule::Constant(0.3);
  EXPECT_EQ(constant.At(0), 0.3);
  EXPECT_EQ(constant.At(1'000'000), 0.3);
  const Schedule line{1.0, 0.2, 1000};
  EXPECT_EQ(line.At(0), 1.0);
  EXPECT_DOUBLE_EQ(line.At(250), 0.8);
  EXPECT_DOUBLE_EQ(line.At(999), 0.2008);
  EXPECT_EQ(line.At(1000), 0.2);
  EXPECT_EQ(line.At(uint64_t{1} << 63), 0.2);
}

TEST(Schedule, AMeanIsThatOfTheLineAndOfWhatFollowsIt) {
  const Schedule line{2, 1, 100};
  EXPECT_DOUBLE_EQ(line.Mean(0, 100), 1.5);
  EXPECT_DOUBLE_EQ(line.Mean(50, 150), (50 * 1.25 + 50 * 1) / 100);
  EXPECT_DOUBLE_EQ(line.Integral(50, 150), 112.5);
  EXPECT_EQ(line.Mean(100, 300), 1);
  EXPECT_EQ(line.Mean(200, 300), 1);
  EXPECT_EQ(line.Mean(50, 50), 1.5);
  EXPECT_EQ(line.Integral(50, 50), 0);
  EXPECT_EQ(line.Least(), 1);
  EXPECT_EQ(line.Most(), 2);
}

// Grants for steps in pieces add up to the grant for all.
TEST(Schedule, AnIntegralIsTheSumOverItsEnvSteps) {
  Random random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const Schedule line{random.Uniform(-2, 2), random.Uniform(-2, 2),
                        1 + static_cast<int64_t>(random.Below(400))};
    uint64_t at = random.Below(300);
    const uint64_t first = at;
    double sum = 0, pieces = 0;
    for (int piece = 0; piece < 20; ++piece) {
      const uint64_t to = at + random.Below(30);
      pieces += line.Integral(at, to);
      for (; at < to; ++at) sum += (line.At(at) + line.At(at + 1)) / 2;
    }
    ASSERT_NEAR(pieces, sum, 1e-9) << ScheduleText(line) << " from " << first << " to " << at;
    ASSERT_NEAR(line.Integral(first, at), sum, 1e-9) << ScheduleText(line);
  }
}

TEST(Schedule, AConstantsMeanIsItToTheBit) {
  const Schedule constant = Schedule::Constant(0.1);
  for (const uint64_t steps : {uint64_t{0}, uint64_t{3}, uint64_t{49}, uint64_t{1} << 60}) {
    EXPECT_EQ(constant.Mean(7, 7 + steps), 0.1) << steps;
    EXPECT_EQ(constant.Integral(7, 7 + steps), 0.1 * static_cast<double>(steps)) << steps;
  }
}

TEST(Schedule, TextIsReadStrictly) {
  EXPECT_EQ(ParseSchedule("linear(1,0.1,100000)"), (Schedule{1, 0.1, 100'000}));
  EXPECT_EQ(ParseSchedule("linear(1.0, 1e-1, 100000)"), (Schedule{1, 0.1, 100'000}));
  EXPECT_EQ(ParseSchedule("linear(-1,0,1)"), (Schedule{-1, 0, 1}));
  for (const char* text : {"",
                           "linear",
                           "linear()",
                           "linear(1,2)",
                           "linear(1,2,3",
                           "linear(1,2,3))",
                           "linear(1,2,3) ",
                           " linear(1,2,3)",
                           "Linear(1,2,3)",
                           "linear(1;2;3)",
                           "linear(1 ,2,3)",
                           "linear(1,2,3.5)",
                           "linear(1,2,1e5)",
                           "linear(1,2,0)",
                           "linear(1,2,-3)",
                           "linear(1,2,1000000000001)",
                           "linear(nan,2,3)",
                           "linear(1,inf,3)",
                           "linear(,2,3)",
                           "linear(1,2,3,4)",
                           "0.5",
                           "constant(1)"}) {
    EXPECT_FALSE(ParseSchedule(text)) << text;
  }
}

TEST(Schedule, TextSaysTheNumbersExactly) {
  const Schedule line{0.1, 1.0 / 3, 12'345};
  EXPECT_EQ(ParseSchedule(ScheduleText(line)), line);
  EXPECT_EQ(ScheduleText({1, 0.1, 100'000}), "linear(1,0.1,100000)");
}

TEST(ScheduleKey, IsANumberOrAText) {
  Config config;
  ApplyAssignments({"exploration.sigma=0.25"}, &config);
  EXPECT_EQ(config.exploration.sigma, Schedule::Constant(0.25));
  EXPECT_EQ(ToJson(config)["exploration"]["sigma"], 0.25);
  ApplyAssignments({"exploration.sigma=linear(1,0.1,5000)"}, &config);
  EXPECT_EQ(config.exploration.sigma, (Schedule{1, 0.1, 5000}));
  EXPECT_EQ(ToJson(config)["exploration"]["sigma"], "linear(1,0.1,5000)");
  Config again;
  ApplyJson(ToJson(config), "its own JSON", &again);
  EXPECT_EQ(again.exploration.sigma, config.exploration.sigma);
}

TEST(ScheduleKey, EveryNumberOfItIsHeldToTheRange) {
  for (const char* value : {"-0.1", "11", "linear(-0.1,0.1,5000)", "linear(1,11,5000)",
                            "linear(1,0.1)", "true", "[1]", "\"0.5\""}) {
    Config config;
    try {
      ApplyAssignments({std::string("exploration.sigma=") + value}, &config);
      ADD_FAILURE() << "took " << value;
    } catch (const Error& e) {
      EXPECT_EQ(e.exit_code(), 2);
      EXPECT_NE(std::string(e.what()).find("linear(START,END,ENV_STEPS)"), std::string::npos)
          << e.what();
    }
  }
}

TEST(ScheduleKey, SamplesPerInsertIsANumberOrAScheduleAboveZero) {
  Config config;
  EXPECT_EQ(ToJson(config)["replay"]["samples_per_insert"].dump(), "64.0");
  const uint64_t usual = ConfigHash(config);
  ApplyAssignments({"replay.samples_per_insert=0"}, &config);
  Validate(config);  // no limit
  ApplyAssignments({"replay.samples_per_insert=linear(64,8,5000)"}, &config);
  Validate(config);
  EXPECT_EQ(config.replay.samples_per_insert, (Schedule{64, 8, 5000}));
  EXPECT_EQ(ToJson(config)["replay"]["samples_per_insert"], "linear(64,8,5000)");
  EXPECT_NE(ConfigHash(config), usual);
  Config again;
  ApplyJson(ToJson(config), "its own JSON", &again);
  EXPECT_EQ(again.replay.samples_per_insert, config.replay.samples_per_insert);
  EXPECT_THROW(ApplyAssignments({"replay.samples_per_insert=linear(64,-1,5000)"}, &again), Error);
}

TEST(ExplorationKeys, AreCheckedTogether) {
  Config config;
  config.exploration.kind = "ou";
  config.exploration.theta = 100;
  config.exploration.dt = 0.01;
  Validate(config);
  config.exploration.dt = 0.02;
  EXPECT_THROW(Validate(config), Error);
  config = Config();
  config.exploration.kind = "squashed_gaussian";
  Validate(config);
  config.learner.algorithm = "td3";
  try {
    Validate(config);
    FAIL() << "a deterministic policy has no deviation";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("gaussian | ou"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace shoal
