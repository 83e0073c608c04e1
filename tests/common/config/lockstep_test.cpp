#include "common/config/lockstep.h"

#include <gtest/gtest.h>

#include <utility>

namespace shoal {
namespace {

Config Lockstep(int64_t min_size, int envs, int steps, double ratio, int batch) {
  Config config;
  config.lockstep = true;
  config.replay.min_size = min_size;
  config.envs_per_actor = envs;
  config.lockstep_steps = steps;
  config.replay.samples_per_insert = ratio;
  config.learner.batch = batch;
  return config;
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

TEST(Lockstep, WithoutALimitAPhaseIsOneUpdate) {
  EXPECT_EQ(LockstepUpdatesAtPhaseEnd(Lockstep(100, 2, 8, 0, 64), 7), 7u);
}

TEST(Lockstep, AnUpdateWaitsForExactlyTheStepsOfItsPhase) {
  for (const Config& config : {Lockstep(1000, 4, 8, 64, 128), Lockstep(100, 1, 3, 12.8, 128),
                               Lockstep(50, 3, 5, 7.7, 13), Lockstep(10, 2, 4, 0, 8)}) {
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
