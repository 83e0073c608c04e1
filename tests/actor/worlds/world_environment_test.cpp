// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/world_environment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "actor/worlds/world_registry.h"
#include "common/base/error.h"
#include "common/tasks/task_registry.h"
#include "tests/actor/worlds/played_environment.h"
#include "tests/support/error_message.h"
#include "tests/support/paths.h"

namespace shoal::worlds {
namespace {

Config Pixels() {
  Config config;
  config.task = "FetchReachDense";
  return config;
}

// Names of the observed blocks.
std::vector<std::string> BlockNames(const Config& config) {
  std::vector<std::string> names;
  const auto environment = Make(config);
  for (const BlockSpec& block : environment->spec().blocks) {
    if (block.observed) names.push_back(block.name);
  }
  return names;
}

// How many bytes of the pages that lie within `size` bytes from `start` are in memory.
size_t ResidentBytes(mjtByte* start, size_t size) {
  const auto page = static_cast<size_t>(sysconf(_SC_PAGESIZE));
  const size_t before = (page - reinterpret_cast<uintptr_t>(start) % page) % page;
  std::vector<unsigned char> pages((size - before) / page);
  EXPECT_EQ(mincore(start + before, page * pages.size(), pages.data()), 0);
  return page * static_cast<size_t>(std::ranges::count_if(pages, [](int p) { return p & 1; }));
}

using Names = std::vector<std::string>;

TEST(WorldEnvironment, FromPixelsAloneBlocksAreRecordedAndNotSeen) {
  const auto environment = Make(Pixels());
  const ObservationSpec& spec = environment->spec();
  EXPECT_EQ(spec.VectorSize(), 0);
  EXPECT_EQ(spec.RecordedVectorSize(), 10 + 3 + 3);
  EXPECT_EQ(spec.Recorded("grip_velocity"), (ObservationSpec::Range{5, 3}));
  EXPECT_EQ(spec.Recorded("achieved_goal"), (ObservationSpec::Range{10, 3}));
  EXPECT_EQ(spec.Recorded("desired_goal"), (ObservationSpec::Range{13, 3}));
  EXPECT_EQ(spec.cameras, (Names{"front", "side"}));
  EXPECT_EQ(spec.channels, 6);
  EXPECT_EQ(spec.height, 84);
  EXPECT_EQ(spec.width, 84);
  EXPECT_EQ(spec.action_size, 4);
  EXPECT_EQ(spec.task, "FetchReachDense");
}

TEST(WorldEnvironment, TheGoalModeDecidesTheGoalBlocks) {
  Config config = Pixels();
  config.observation.goal_mode = "desired";
  EXPECT_EQ(BlockNames(config), Names{"desired_goal"});
  config.observation.goal_mode = "both";
  EXPECT_EQ(BlockNames(config), (Names{"achieved_goal", "desired_goal"}));
  config.observation.proprioception = true;
  EXPECT_EQ(BlockNames(config), (Names{"grip", "fingers", "grip_velocity", "finger_velocities",
                                       "achieved_goal", "desired_goal"}));
  config.observation.goal_mode = "none";
  EXPECT_EQ(BlockNames(config), (Names{"grip", "fingers", "grip_velocity", "finger_velocities"}));
}

TEST(WorldEnvironment, StateBlocksAreSeenByNameInThePublishedOrder) {
  Config config = Pixels();
  config.task = "FetchPush";
  config.observation.goal_mode = "desired";
  config.observation.proprioception = StateBlocks({"grip_velocity", "grip", "fingers"});
  EXPECT_EQ(BlockNames(config), (Names{"grip", "fingers", "grip_velocity", "desired_goal"}));
  config.observation.proprioception = StateBlocks({"grip", "objekt"});
  try {
    Make(config);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    EXPECT_THAT(error.what(), testing::HasSubstr("block 'objekt'; the state blocks of FetchPush "
                                                 "are: grip, object, object_from_grip, fingers"));
  }
}

TEST(WorldEnvironment, WithHindsightPicturesDoNotShowTheGoal) {
  Config config = Pixels();
  config.observation.goal_mode = "desired";
  Player shown(Make(config));
  config.replay.hindsight = "future";
  Player hidden(Make(config));
  EXPECT_NE(hidden.environment->spec().Hash(), shown.environment->spec().Hash());
  // The arm starts every episode in the same place: two first frames differ by their goals alone.
  const auto first_frame = [](Player* player, uint64_t key) {
    player->Reset(key);
    return player->frame;
  };
  EXPECT_NE(first_frame(&shown, 1), first_frame(&shown, 2));
  EXPECT_EQ(first_frame(&hidden, 1), first_frame(&hidden, 2));
}

// Mean difference of two pictures in grey levels.
double Difference(std::span<const uint8_t> one, std::span<const uint8_t> other) {
  double sum = 0;
  for (size_t i = 0; i < one.size(); ++i) sum += std::abs(one[i] - other[i]);
  return sum / static_cast<double>(one.size());
}

TEST(WorldEnvironment, AnImageGoalIsAPictureOfItsOwnAndHidesTheMarker) {
  Config config = Pixels();
  config.observation.goal_mode = "image";
  Player player(Make(config));
  const ObservationSpec& spec = player.environment->spec();
  EXPECT_TRUE(spec.goal_picture);
  EXPECT_TRUE(BlockNames(config).empty());
  EXPECT_EQ(spec.InputChannels(), 2 * spec.channels);
  player.Reset(1);
  const std::vector<uint8_t> frame = player.frame;
  const auto picture = player.environment->goal_picture();
  ASSERT_EQ(picture.size(), frame.size());
  const std::vector<uint8_t> first(picture.begin(), picture.end());
  EXPECT_GT(Difference(first, frame), 0.5) << "the arm has moved to the goal";
  player.Reset(2);
  EXPECT_EQ(player.frame, frame) << "the goal shows in its picture alone";
  EXPECT_GT(Difference(first, player.environment->goal_picture()), 0.1);
  player.Reset(1);
  EXPECT_TRUE(std::ranges::equal(first, player.environment->goal_picture()));
}

TEST(WorldEnvironment, DrawingTheGoalLeavesTheEpisodeAsItWas) {
  for (const char* task : {"FetchReach", "FetchPush", "FetchSlide", "FetchPickAndPlace"}) {
    Config config = Pixels();
    config.task = task;
    config.replay.hindsight = "future";
    config.observation.goal_mode = "desired";
    Player without(Make(config));
    config.observation.goal_mode = "image";
    Player with(Make(config));
    without.Reset(5);
    with.Reset(5);
    const std::vector<float> action{0.5F, -1, -0.25F, 1};
    for (int step = 0; step < 10; ++step) {
      ASSERT_EQ(with.vector, without.vector) << task << ", step " << step;
      ASSERT_EQ(with.frame, without.frame) << task << ", step " << step;
      with.environment->Step(action, {with.frame, with.vector});
      without.environment->Step(action, {without.frame, without.vector});
    }
  }
}

TEST(WorldEnvironment, ATaskThatCannotShowItsGoalHasNoImageGoals) {
  Config config = Pixels();
  config.task = "Hopper-v4";
  config.observation.cameras = {"track"};
  config.observation.goal_mode = "image";
  EXPECT_THAT(UsageMessage([&] { Make(config); }),
              testing::HasSubstr("task Hopper-v4 has no goals"));
}

TEST(WorldEnvironment, WithoutPixelsTheStateIsAlwaysSeen) {
  Config config = StateOnly();
  EXPECT_EQ(BlockNames(config), (Names{"grip", "fingers", "grip_velocity", "finger_velocities",
                                       "achieved_goal", "desired_goal"}));
  config.observation.goal_mode = "none";
  EXPECT_EQ(BlockNames(config), (Names{"grip", "fingers", "grip_velocity", "finger_velocities"}));
  const auto environment = Make(config);
  EXPECT_FALSE(environment->spec().HasPixels());
  EXPECT_EQ(environment->spec().FrameBytes(), 0);
  EXPECT_TRUE(environment->spec().cameras.empty());
}

TEST(WorldEnvironment, BlocksLieInSpecOrder) {
  Player player(Make(StateOnly()));
  const float distance = player.Reset(3);
  const std::span<const float> vector(player.vector);
  ASSERT_EQ(vector.size(), 16u);
  const auto grip = vector.first(3), achieved = vector.subspan(10, 3), desired = vector.last(3);
  EXPECT_TRUE(std::equal(grip.begin(), grip.end(), achieved.begin()));
  EXPECT_FLOAT_EQ(distance, std::hypot(achieved[0] - desired[0], achieved[1] - desired[1],
                                       achieved[2] - desired[2]));
}

TEST(WorldEnvironment, AnEpisodeIsTruncatedAtItsFiftiethStepAndNeverTerminates) {
  Player player(Make(StateOnly()));
  for (int episode = 0; episode < 2; ++episode) {
    player.Reset(static_cast<uint64_t>(episode));
    for (int step = 1; step <= 50; ++step) {
      const StepResult result = player.Step();
      EXPECT_FALSE(result.terminated);
      EXPECT_EQ(result.truncated, step == 50) << step;
    }
  }
}

TEST(WorldEnvironment, TheStepRewardIsTheGoalHalfsRewardOfThePublishedGoals) {
  for (const char* name : {"FetchReach", "FetchReachDense"}) {
    const tasks::Task& task = tasks::FindTask(name);
    Player player(Make(StateOnly(name)));
    const std::span<const float> vector(player.vector);
    const auto achieved = vector.subspan(10, 3), desired = vector.last(3);
    const float start = player.Reset(4);
    ASSERT_GT(start, 0.05f);
    int successes = 0;
    for (int step = 0; step < 50; ++step) {
      std::array<float, 4> action{};
      for (size_t i = 0; i < 3; ++i) {
        action[i] = std::clamp(10 * (desired[i] - achieved[i]), -1.0f, 1.0f);
      }
      const StepResult result = player.environment->Step(action, {{}, player.vector});
      float reward = 0;
      task.ComputeRewards(achieved, desired, std::span(&reward, 1));
      ASSERT_EQ(result.reward, reward);
      ASSERT_EQ(result.success, result.distance < 0.05f);
      successes += result.success;
    }
    // Moving towards the goal reaches it and stays; the first steps are still far away.
    EXPECT_GT(successes, 30);
    EXPECT_LT(successes, 50);
  }
}

TEST(WorldEnvironment, EqualKeysGiveBitIdenticalEpisodesWhateverHappenedBefore) {
  Config config = Pixels();
  config.observation.goal_mode = "both";
  Player fresh(Make(config)), used(Make(config));
  used.Play(100, 7);
  used.Play(101, 50);
  const auto episode = fresh.Play(102, 12);
  EXPECT_EQ(used.Play(102, 12), episode);
  EXPECT_NE(used.Play(103, 12), episode);
}

TEST(WorldEnvironment, InterleavedEnvironmentsOfOneContextDoNotTouchEachOther) {
  Config config = Pixels();
  config.observation.goal_mode = "both";
  Player alone(Make(config));
  const auto expected = alone.Play(7, 6);
  const auto render = MakeRenderContext(config.observation);
  Player left(MakeEnvironment(config, render)), right(MakeEnvironment(config, render));
  left.Reset(7);
  right.Reset(8);
  auto seen = std::pair(left.frame, left.vector);
  for (int i = 0; i < 6; ++i) {
    right.Step();
    left.Step();
    seen.first.insert(seen.first.end(), left.frame.begin(), left.frame.end());
    seen.second.insert(seen.second.end(), left.vector.begin(), left.vector.end());
  }
  EXPECT_EQ(seen, expected);
}

TEST(WorldEnvironment, DrawingDoesNotChangeAnEpisode) {
  Config config = Pixels();
  config.observation.goal_mode = "both";
  config.observation.proprioception = true;
  Player seeing(Make(config)), blind(Make(StateOnly()));
  EXPECT_EQ(seeing.Play(9, 15).second, blind.Play(9, 15).second);
}

// The sky of a Control Suite model is 11.5 MB.
TEST(WorldEnvironment, EnvironmentsDoNotKeepTheirModelsTextures) {
  Config config = Pixels();
  config.task = "cartpole_swingup";
  config.observation.cameras = {"fixed"};
  const tasks::Task& task = tasks::FindTask(config.task);
  const auto render = MakeRenderContext(config.observation);
  std::vector<std::unique_ptr<Environment>> environments;
  for (int i = 0; i < 2; ++i) {  // the first one's textures are drawn with
    std::unique_ptr<World> made = MakeWorld(task.world(), {});
    const mjModel& model = made->model();
    const auto size = static_cast<size_t>(model.ntexdata);
    EXPECT_GT(ResidentBytes(model.tex_rgb, size), 10'000'000u);
    environments.push_back(
        std::make_unique<WorldEnvironment>(task, std::move(made), config, render));
    EXPECT_EQ(ResidentBytes(model.tex_rgb, size), 0u);
  }
}

TEST(WorldEnvironment, TheFingerprintIsThatOfModelAndPicture) {
  const auto fingerprint = [](const Config& config) {
    return Make(config)->spec().model_fingerprint;
  };
  const Config config = Pixels();
  Config quality = config, cameras = config;
  quality.observation.quality = "reference";
  cameras.observation.cameras = {"side", "front"};
  EXPECT_EQ(fingerprint(config), fingerprint(config));
  EXPECT_NE(fingerprint(config), fingerprint(quality));
  EXPECT_NE(fingerprint(config), fingerprint(cameras));
  EXPECT_NE(fingerprint(config), fingerprint(StateOnly()));
  Config model = StateOnly();
  model.model = SourcePath("tests/actor/worlds/other_reach.xml");
  EXPECT_NE(fingerprint(model), fingerprint(StateOnly()));
}

TEST(WorldEnvironment, RefusesWhatDoesNotExistByName) {
  const auto message = [](const Config& config) -> std::string {
    try {
      Make(config);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  Config config = Pixels();
  config.task = "FetchJuggle";
  EXPECT_THAT(message(config), testing::HasSubstr("FetchJuggle"));
  config = Pixels();
  config.observation.cameras = {"front", "behind"};
  EXPECT_THAT(message(config), testing::HasSubstr("behind"));
  config = StateOnly();
  config.observation.goal_mode = "some";
  EXPECT_THAT(message(config), testing::HasSubstr("some"));
  config = StateOnly();
  config.model = "/nonexistent.xml";
  EXPECT_THAT(message(config), testing::HasSubstr("/nonexistent.xml"));
}

TEST(WorldEnvironment, AnActionOutsideItsBoundsOrNotANumberIsAnErrorNamingIt) {
  Player player(Make(StateOnly()));
  for (const float bad : {1.01f, -2.0f, std::numeric_limits<float>::quiet_NaN()}) {
    player.Reset(1);
    const std::array<float, 4> action{0, 0, bad, 0};
    try {
      player.environment->Step(action, {{}, player.vector});
      FAIL() << "took " << bad;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("2 (dz)"));
      EXPECT_EQ(error.exit_code(),
                static_cast<int>(std::isnan(bad) ? ErrorKind::kNonFinite : ErrorKind::kRuntime));
    }
  }
}

TEST(WorldEnvironmentDeathTest, AStepNeedsAnEpisode) {
  Player player(Make(StateOnly()));
  EXPECT_DEATH(player.Step(), "step -1");
  player.Reset(1);
  for (int i = 0; i < 50; ++i) player.Step();
  EXPECT_DEATH(player.Step(), "step 50");
}

TEST(WorldEnvironment, ActionRepeatOfATaskWithGoalsAddsTheRewardsOfItsControlSteps) {
  Config twice = StateOnly();
  twice.action_repeat = 2;
  Player single(Make(StateOnly())), repeated(Make(twice));
  single.Reset(3);
  repeated.Reset(3);
  const std::array<float, 4> action{0.5f, -0.5f, 0, 0};
  for (int env_step = 1; env_step <= 25; ++env_step) {
    const float first = single.environment->Step(action, {{}, single.vector}).reward;
    const StepResult second = single.environment->Step(action, {{}, single.vector});
    const StepResult both = repeated.environment->Step(action, {{}, repeated.vector});
    EXPECT_FLOAT_EQ(both.reward, first + second.reward);
    EXPECT_EQ(both.distance, second.distance);
    EXPECT_EQ(both.truncated, env_step == 25);
    EXPECT_EQ(repeated.vector, single.vector);
  }
}

}  // namespace
}  // namespace shoal::worlds
