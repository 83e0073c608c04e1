// SPDX-License-Identifier: Apache-2.0
#include "launch/run/first_split.h"

#include <gtest/gtest.h>

#include "common/config/config_io.h"
#include "learner/agent/update_cost.h"

namespace shoal::launch {
namespace {

RunConfig FlagshipRun() {
  RunConfig run;
  run.config.env_steps = 52'000;
  run.config.replay.samples_per_insert = Schedule::Constant(16);
  run.config.network.encoder = "spatial_softmax";
  run.spec.cameras = {"front", "side"};
  run.spec.channels = 6;
  run.spec.height = run.spec.width = 84;
  run.spec.stack = 1;
  run.spec.action_size = 4;
  return run;
}

TEST(FirstSplit, CostsAreThoseOfTheStepAndOfTheArithmetic) {
  const RunConfig run = FlagshipRun();
  const auto costs = ExpectedCosts(run, /*step_microseconds=*/1000);
  ASSERT_TRUE(costs);
  EXPECT_NEAR(costs->env_step, 1.1e-3, 1e-9) << "and choosing actions";
  EXPECT_DOUBLE_EQ(costs->updates_per_env_step, 16.0 / 128);
  const double flop = learner::CostOfUpdate(run.config, run.spec).flop;
  EXPECT_GT(costs->update, flop / 200e9);
  EXPECT_LT(costs->update, flop / 10e9);
  EXPECT_FALSE(ExpectedCosts(run, 0)) << "not measured";
}

TEST(FirstSplit, WhatWasGivenIsALimit) {
  const auto limits = LimitsOfSplit(FlagshipRun().config, /*other_hosts=*/false, 16);
  ASSERT_TRUE(limits);
  EXPECT_EQ(limits->cores, 16);
  EXPECT_EQ(limits->most_threads, 16) << "8 rows each";
  EXPECT_FALSE(limits->actors);
  EXPECT_FALSE(limits->threads);
  Config given = FlagshipRun().config;
  given.actors = 3;
  EXPECT_EQ(LimitsOfSplit(given, false, 16)->actors, 3);
  given.learner.threads = 2;
  EXPECT_FALSE(LimitsOfSplit(given, false, 16)) << "both were given";
}

TEST(FirstSplit, RunsThatKeepTheirNumbers) {
  const auto divides = [](const auto& change) {
    Config config = FlagshipRun().config;
    change(config);
    return LimitsOfSplit(config, false, 16).has_value();
  };
  EXPECT_TRUE(divides([](Config&) {}));
  EXPECT_FALSE(divides([](Config& c) { c.lockstep = true; }));
  EXPECT_FALSE(divides([](Config& c) { c.learner.algorithm = "ppo"; }));
  EXPECT_FALSE(divides([](Config& c) { c.observation.pixels = false; }));
  EXPECT_FALSE(divides([](Config& c) { c.replay.samples_per_insert = Schedule::Constant(0); }));
  EXPECT_FALSE(LimitsOfSplit(FlagshipRun().config, /*other_hosts=*/true, 16));
  EXPECT_FALSE(LimitsOfSplit(FlagshipRun().config, false, kLeastCores - 1));
}

}  // namespace
}  // namespace shoal::launch
