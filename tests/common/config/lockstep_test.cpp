// SPDX-License-Identifier: Apache-2.0
#include "common/config/lockstep.h"

#include <gtest/gtest.h>

#include <utility>

namespace shoal {
namespace {

Config Lockstep(int64_t min_size, int envs, int steps, Schedule ratio, int batch) {
  Config config;
  config.lockstep = true;
  config.replay.min_size = min_size;
  config.envs_per_actor = envs;
  config.lockstep_steps = steps;
  config.replay.samples_per_insert = ratio;
  config.learner.batch = batch;
  return config;
}
Config Lockstep(int64_t min_size, int envs, int steps, double ratio, int batch) {
  return Lockstep(min_size, envs, steps, Schedule::Constant(ratio), batch);
}

TEST(Lockstep, PhaseZeroFillsTheReplayToItsMinimum) {
  // 1000 / 4 = 250 vector steps, rounded up to 256 = 32 * 8.
  const Config config = Lockstep(1000, 4, 8, 64, 128);
  EXPECT_EQ(LockstepVectorStepsAtPhaseEnd(config, 0), 256);
  EXPECT_EQ(LockstepVectorStepsAtPhaseEnd(config, 1), 264);
  EXPECT_EQ(LockstepVectorStepsAtPhaseEnd(config, 100), 1056);
  EXPECT_EQ(LockstepUpdatesAtPhaseEnd(config, 0), 0u);
}

TEST(Lockstep, ExactMinimumIsNotRoundedUp) {
  EXPECT_EQ(LockstepVectorStepsAtPhaseEnd(Lockstep(1024, 4, 8, 64, 128), 0), 256);
  EXPECT_EQ(LockstepVectorStepsAtPhaseEnd(Lockstep(1025, 4, 8, 64, 128), 0), 264);
}

TEST(Lockstep, UpdatesPerPhaseFollowSamplesPerInsert) {
  // 64 samples * 8 steps * 4 envs / 128 per batch = 16.
  const Config config = Lockstep(1000, 4, 8, 64, 128);
  EXPECT_EQ(LockstepUpdatesAtPhaseEnd(config, 1), 16u);
  EXPECT_EQ(LockstepUpdatesAtPhaseEnd(config, 1000), 16000u);
}

TEST(Lockstep, RoundsOverTheRunSoThatTheRatioIsKept) {
  // 0.3 updates per phase: some phases have none.
  const Config config = Lockstep(100, 1, 3, 12.8, 128);
  EXPECT_EQ(LockstepUpdatesAtPhaseEnd(config, 3), 0u);
  EXPECT_EQ(LockstepUpdatesAtPhaseEnd(config, 4), 1u);
  EXPECT_EQ(LockstepUpdatesAtPhaseEnd(config, 10), 3u);
  EXPECT_EQ(LockstepUpdatesAtPhaseEnd(config, 1'000'000), 300'000u);
}

// The grants of a schedule are summed step by step, from the end of phase 0 on.
TEST(Lockstep, UpdatesFollowAScheduleOfSamplesPerInsert) {
  const Schedule ratio{40, 4, 1500};
  const Config config = Lockstep(1000, 2, 3, ratio, 16);  // phase 0 ends after 1002 env steps
  double granted = 0;
  uint64_t step = 1002;
  for (int64_t phase = 1; phase < 300; ++phase) {
    for (const uint64_t end = 1002 + 6 * static_cast<uint64_t>(phase); step < end; ++step) {
      granted += (ratio.At(step) + ratio.At(step + 1)) / 2;
    }
    ASSERT_EQ(LockstepUpdatesAtPhaseEnd(config, phase), static_cast<uint64_t>(granted / 16 + 1e-6))
        << phase;
  }
  EXPECT_GT(step, 1500u) << "beyond the end of the schedule";
}

TEST(Lockstep, AConstantScheduleCountsAsTheProductOfItsPhases) {
  for (const double ratio : {0.1, 7.7, 12.8, 1.0 / 3, 63.999}) {
    const Config config = Lockstep(50, 3, 5, ratio, 13);
    const double per_phase = ratio * 5 * 3 / 13;
    for (int64_t phase = 0; phase < 5000; ++phase) {
      ASSERT_EQ(LockstepUpdatesAtPhaseEnd(config, phase),
                static_cast<uint64_t>(static_cast<double>(phase) * per_phase + 1e-6));
    }
  }
}

TEST(Lockstep, WithoutALimitAPhaseIsOneUpdate) {
  EXPECT_EQ(LockstepUpdatesAtPhaseEnd(Lockstep(100, 2, 8, 0, 64), 7), 7u);
}

TEST(Lockstep, AnUpdateWaitsForExactlyTheStepsOfItsPhase) {
  for (const Config& config :
       {Lockstep(1000, 4, 8, 64, 128), Lockstep(100, 1, 3, 12.8, 128), Lockstep(50, 3, 5, 7.7, 13),
        Lockstep(10, 2, 4, 0, 8), Lockstep(50, 3, 5, Schedule{9, 0.5, 1200}, 13),
        Lockstep(10, 2, 4, Schedule{0.01, 3, 300}, 8)}) {
    uint64_t update = 1;
    for (int64_t phase = 1; phase < 200; ++phase) {
      const auto steps = static_cast<uint64_t>(LockstepVectorStepsAtPhaseEnd(config, phase) *
                                               config.envs_per_actor);
      for (; update <= LockstepUpdatesAtPhaseEnd(config, phase); ++update) {
        ASSERT_EQ(LockstepStepsBeforeUpdate(config, update), steps) << update;
      }
    }
    EXPECT_GT(update, 1u);
  }
}

TEST(Lockstep, ARunEndsWithTheFirstPhaseThatSpendsTheBudget) {
  Config config = Lockstep(1000, 4, 8, 64, 128);  // phase p ends after 4 * (256 + 8 p) env steps
  for (const auto& [budget, phase] :
       {std::pair{500, 0}, {1024, 0}, {1025, 1}, {1056, 1}, {1057, 2}, {1200, 6}}) {
    config.env_steps = budget;
    EXPECT_EQ(LockstepLastUpdate(config), 16u * phase) << budget;
    EXPECT_EQ(LockstepEnvSteps(config), 1024u + 32u * phase) << budget;
  }
}

}  // namespace
}  // namespace shoal
