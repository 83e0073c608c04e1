// SPDX-License-Identifier: Apache-2.0
// A world of seven control steps, whose physics half pays the action itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "actor/worlds/model_loading.h"
#include "actor/worlds/world_environment.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::worlds {
namespace {

// A task without goals: its reward and its end come from the physics half.
class Countdown final : public World {
 public:
  // `reward_factor` and `observation_factor` can make rewards and observations invalid.
  explicit Countdown(double reward_factor = 1, double observation_factor = 1)
      : World(Load()), reward_factor_(reward_factor), observation_factor_(observation_factor) {}

  void Reset(Random*) override { left_ = 7; }
  Outcome Step(std::span<const double> action) override {
    --left_;
    return {.reward = reward_factor_ * action[0], .terminated = left_ == 0};
  }
  void Observe(std::span<double> observation, std::span<double>, std::span<double>) const override {
    observation[0] = observation_factor_ * left_;
  }
  std::span<const CameraView> cameras() const override { return {}; }

 private:
  static ModelHandle Load() {
    const TemporaryFolder folder;
    WriteFileAtomically(folder.path() / "nothing.xml", "<mujoco><worldbody/></mujoco>");
    return LoadModel("", (folder.path() / "nothing.xml").string());
  }

  const double reward_factor_, observation_factor_;
  int left_ = 0;
};

tasks::Task CountdownTask(int episode_length) {
  tasks::Task::Description description;
  description.name = "Countdown";
  description.episode_length = episode_length;
  description.action = {{"push", ""}};
  description.observation = {{"observation", {{"left", ""}}}};
  return tasks::Task(description);
}

TEST(TaskWithoutGoals, TakesRewardAndEndFromThePhysics) {
  const tasks::Task task = CountdownTask(/*episode_length=*/10);
  WorldEnvironment environment(task, std::make_unique<Countdown>(), Config(), nullptr);
  ASSERT_EQ(environment.spec().blocks, (std::vector<BlockSpec>{{"observation", 1}}));

  std::array<float, 1> left{};
  const std::array<float, 1> action{0.25f};
  EXPECT_TRUE(std::isnan(environment.Reset(1, {{}, left})));
  for (int step = 1; step <= 7; ++step) {
    const StepResult result = environment.Step(action, {{}, left});
    EXPECT_EQ(result.reward, 0.25f);
    EXPECT_EQ(result.terminated, step == 7);
    EXPECT_FALSE(result.truncated);
    EXPECT_FALSE(result.success);
    EXPECT_TRUE(std::isnan(result.distance));
  }
  EXPECT_EQ(left[0], 0.0f);
}

TEST(WorldEnvironment, WithHindsightAGoalThatCannotBeHiddenIsRefused) {
  tasks::Task::Description description;
  description.name = "Countdown";
  description.episode_length = 10;
  description.action = {{"push", ""}};
  description.achieved_goal = {"achieved_goal", {{"x", "m"}}};
  description.desired_goal = {"desired_goal", {{"x", "m"}}};
  Config config;
  config.observation.cameras = {};
  config.replay.hindsight = "final";
  config.observation.goal_mode = "desired";
  try {
    const WorldEnvironment environment(tasks::Task(description), std::make_unique<Countdown>(),
                                       config, MakeRenderContext(config.observation));
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    EXPECT_THAT(error.what(), testing::HasSubstr("pictures of task Countdown show the goal"));
  }
}

TEST(TaskWithoutGoals, ANumberThatIsNotFiniteIsAnErrorOfItsOwnExitCode) {
  const auto failure = [](double reward_factor, double observation_factor) -> std::string {
    WorldEnvironment environment(CountdownTask(10),
                                 std::make_unique<Countdown>(reward_factor, observation_factor),
                                 Config(), nullptr);
    std::array<float, 1> left{};
    const std::array<float, 1> action{0.25f};
    try {
      environment.Reset(1, {{}, left});
      environment.Step(action, {{}, left});
    } catch (const Error& error) {
      EXPECT_EQ(error.exit_code(), static_cast<int>(ErrorKind::kNonFinite));
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(failure(1, 1), "");
  EXPECT_THAT(failure(std::nan(""), 1),
              testing::HasSubstr("Countdown: the reward is nan after 1 "));
  EXPECT_THAT(failure(1, HUGE_VAL),
              testing::HasSubstr("left of block 'observation' is inf after 0 control steps"));
  EXPECT_NE(failure(1e300, 1), "") << "finite as a double, infinite as a record's float32";
  EXPECT_NE(failure(1, 1e300), "");
}

TEST(TaskWithoutGoals, HasNoGoalBlocks) {
  const tasks::Task task = CountdownTask(5);
  Config config;
  config.observation.goal_mode = "both";
  try {
    WorldEnvironment environment(task, std::make_unique<Countdown>(), config, nullptr);
    FAIL() << "observes goals that are not there";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    EXPECT_THAT(error.what(), testing::HasSubstr("Countdown has no goals"));
  }
}

// 7 control steps to the end of the task, 5 or 10 to that of the episode; 3 to an env step.
TEST(TaskWithoutGoals, ActionRepeatAddsRewardsAndStopsWhereTheEpisodeEnds) {
  for (const int episode_length : {5, 10}) {
    const tasks::Task task = CountdownTask(episode_length);
    Config config;
    config.action_repeat = 3;
    WorldEnvironment environment(task, std::make_unique<Countdown>(), config, nullptr);
    std::array<float, 1> left{};
    const std::array<float, 1> action{0.25f};
    environment.Reset(1, {{}, left});
    StepResult result;
    std::vector<float> rewards, seen;
    while (!result.terminated && !result.truncated) {
      result = environment.Step(action, {{}, left});
      rewards.push_back(result.reward);
      seen.push_back(left[0]);
    }
    if (episode_length == 5) {
      EXPECT_EQ(rewards, (std::vector<float>{0.75f, 0.5f}));
      EXPECT_EQ(seen, (std::vector<float>{4, 2}));
      EXPECT_TRUE(result.truncated);
    } else {
      EXPECT_EQ(rewards, (std::vector<float>{0.75f, 0.75f, 0.25f}));
      EXPECT_EQ(seen, (std::vector<float>{4, 1, 0}));
      EXPECT_TRUE(result.terminated);
    }
  }
}

}  // namespace
}  // namespace shoal::worlds
