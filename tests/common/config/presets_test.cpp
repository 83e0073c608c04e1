// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/config/config_io.h"

namespace shoal {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;

TEST(Presets, AllLoadAndAreValid) {
  const std::vector<std::string> names = ListPresets();
  EXPECT_THAT(names, IsSupersetOf({"fetch-reach-drq", "fetch-reach-state", "fetch-reach-her"}));
  for (const std::string& name : names) {
    const Config config = LoadPreset(name);
    EXPECT_EQ(config.preset, name);
    Validate(config);
  }
}

TEST(Presets, DrqLearnsFromTwoCamerasAlone) {
  const Config config = LoadPreset("fetch-reach-drq");
  EXPECT_TRUE(config.observation.pixels);
  EXPECT_THAT(config.observation.cameras, ElementsAre("front", "side"));
  EXPECT_EQ(config.observation.goal_mode, "none");
  EXPECT_FALSE(config.observation.proprioception);
}

// Presets with quality native need no OSMesa. The recipe of Stable-Baselines3 uses the original
// environment's pictures, and `pixels` is also for users' environments, which refuse the key.
TEST(Presets, FromPixelsTakeQualityNative) {
  std::vector<std::string> native;
  for (const std::string& name : ListPresets()) {
    const ObservationConfig observation = LoadPreset(name).observation;
    if (!observation.pixels || name == "pixels") continue;
    if (name == "sb3-nature") {
      EXPECT_EQ(observation.quality, "reference");
    } else {
      EXPECT_EQ(observation.quality, "native") << name;
      native.push_back(name);
    }
  }
  EXPECT_THAT(native, IsSupersetOf({"fetch-reach-drq", "fetch-reach-fast", "fetch-push-pixels",
                                    "fetch-reach-pixels-ppo"}));
}

// The settings in which the published runs differ between tasks, and those that follow from them.
TEST(Presets, Drqv2UpdatesInEverySecondEnvStepAndReducesItsNoise) {
  int presets = 0;
  for (const std::string& name : ListPresets()) {
    if (!name.ends_with("-drqv2")) continue;
    SCOPED_TRACE(name);
    ++presets;
    const Config config = LoadPreset(name);
    EXPECT_EQ(name, "dmc-" + config.task + "-drqv2");
    EXPECT_EQ(config.learner.algorithm, "drqv2");
    EXPECT_EQ(config.env_steps * config.action_repeat, 500'000);
    EXPECT_EQ(config.replay.samples_per_insert, Schedule::Constant(config.learner.batch / 2));
    const bool medium = config.task == "reacher_easy" || config.task == "cheetah_run";
    EXPECT_EQ(config.drqv2.noise, (Schedule{1, 0.1, medium ? 500'000 : 100'000}));
    EXPECT_EQ(config.replay.n_step, config.task == "walker_walk" ? 1 : 3);
    EXPECT_EQ(config.learner.batch, config.task == "walker_walk" ? 512 : 256);
  }
  EXPECT_EQ(presets, 6);
}

TEST(Presets, StateRendersNothing) {
  const Config config = LoadPreset("fetch-reach-state");
  EXPECT_FALSE(config.observation.pixels);
  EXPECT_TRUE(config.observation.proprioception);
}

TEST(Presets, HerLearnsFromSparseRewardsAndGoalsOfHindsight) {
  const Config config = LoadPreset("fetch-reach-her");
  EXPECT_EQ(config.task, "FetchReach");
  EXPECT_EQ(config.replay.hindsight, "future");
  EXPECT_EQ(config.observation.goal_mode, "desired");
}

TEST(Presets, RefuseAnUnknownNameListingTheKnown) {
  for (const char* name : {"no-such", "../presets/fetch-reach-drq", ""}) {
    try {
      LoadPreset(name);
      ADD_FAILURE() << name;
    } catch (const Error& e) {
      EXPECT_EQ(e.exit_code(), 2);
      EXPECT_THAT(e.what(), AllOf(HasSubstr("preset"), HasSubstr("fetch-reach-drq")));
    }
  }
}

}  // namespace
}  // namespace shoal
