// SPDX-License-Identifier: Apache-2.0
// A user's faulty tasks (tests/own_task/troubled), in the environment and the tools.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "actor/evaluation/evaluation.h"
#include "actor/evaluation/random_baseline.h"
#include "actor/worlds/custom_cameras.h"
#include "actor/worlds/environment.h"
#include "actor/worlds/episode_fault.h"
#include "actor/worlds/physics_library.h"
#include "actor/worlds/tools/reward_check.h"
#include "actor/worlds/tools/task_description.h"
#include "actor/worlds/world_registry.h"
#include "common/tasks/task_registry.h"
#include "tests/support/error_message.h"
#include "tests/support/paths.h"

namespace shoal::worlds {
namespace {

using testing::AllOf;
using testing::HasSubstr;

Config ConfigOf(const std::string& task) {
  LoadTasks(ProgramPath("troubled.so"));
  Config config;
  config.task = task;
  config.observation.pixels = false;
  config.observation.proprioception = true;
  return config;
}

std::string RefusalAtReset(const std::string& task) {
  return UsageMessage([&] {
    const auto environment = MakeEnvironment(ConfigOf(task), nullptr);
    std::vector<float> numbers(static_cast<size_t>(environment->spec().RecordedVectorSize()));
    environment->Reset(1, {{}, numbers});
    environment->Step(std::vector<float>(static_cast<size_t>(environment->spec().action_size)),
                      {{}, numbers});
  });
}

TEST(Troubled, AWrongBlockSizeIsOneLineWithTaskBlockAndSizes) {
  EXPECT_THAT(
      RefusalAtReset("TroubledLong"),
      HasSubstr("task TroubledLong: block 'velocity' has 2 numbers in the goal half, Observe "
                "wrote 3"));
  EXPECT_THAT(RefusalAtReset("TroubledShort"),
              HasSubstr("task TroubledShort: block 'velocity' has 2 numbers in the goal half, "
                        "Observe wrote 1: velocity_y was never written"));
}

TEST(Troubled, AnActionOfAnotherSizeThanTheModelsIsOneLine) {
  EXPECT_THAT(RefusalAtReset("TroubledControls"),
              HasSubstr("the task's action has 3 numbers, the model has 2 actuators"));
}

TEST(Troubled, AWorldThatIsNoneIsOneLine) {
  EXPECT_THAT(RefusalAtReset("TroubledNothing"), HasSubstr("returned no world"));
}

TEST(Troubled, ANumberThatNeverChangesIsAWarning) {
  ConfigOf("TroubledConstant");
  const RewardCheck check = CheckRewards({.task = "TroubledConstant"});
  EXPECT_TRUE(check.Passed());
  EXPECT_THAT(ToText(check), HasSubstr("warning: velocity_y of block 'velocity' was 0 in all of"));
  ASSERT_EQ(check.constant.size(), 1u);
  const TaskDescription description = DescribeTask({.task = "TroubledConstant"});
  EXPECT_THAT(ToText(description), HasSubstr("warning: velocity_y of block 'velocity' was 0"));
  EXPECT_EQ(ToJson(description).at("constant_numbers").size(), 1u);
  EXPECT_TRUE(CheckRewards({.task = "TroubledTalk", .env_steps = 100}).constant.empty());
}

struct Faults {
  int episodes = 0, faulty = 0;
  std::string message;
};

// Plays whole episodes by zero actions.
Faults Play(const std::string& task, FaultCause cause, int episodes) {
  const auto environment = MakeEnvironment(ConfigOf(task), nullptr);
  std::vector<float> numbers(static_cast<size_t>(environment->spec().RecordedVectorSize()));
  const std::vector<float> action(static_cast<size_t>(environment->spec().action_size));
  Faults faults;
  for (int episode = 0; episode < episodes; ++episode) {
    std::vector<float> before = numbers;
    try {
      environment->Reset(static_cast<uint64_t>(episode), {{}, numbers});
      before = numbers;
      for (bool running = true; running;) {
        before = numbers;
        running = !environment->Step(action, {{}, numbers}).truncated;
      }
    } catch (const EpisodeFault& fault) {
      ++faults.faulty;
      faults.message = fault.what();
      EXPECT_EQ(fault.cause(), cause);
      EXPECT_EQ(fault.exit_code(), 3);
      EXPECT_EQ(numbers, before) << "the last finite observation stays";
    }
    ++faults.episodes;
  }
  return faults;
}

TEST(Troubled, AFaultIsOfOneEpisodeAndNamesTheBlock) {
  const Faults sensor = Play("TroubledSensor", FaultCause::kObservation, 300);
  EXPECT_GT(sensor.faulty, 2);
  EXPECT_LT(sensor.faulty, 25);
  EXPECT_THAT(sensor.message,
              HasSubstr("task TroubledSensor: y of block 'position' is nan after 6 control steps"));
  const Faults reset = Play("TroubledReset", FaultCause::kObservation, 300);
  EXPECT_GT(reset.faulty, 2);
  EXPECT_LT(reset.faulty, 25);
  EXPECT_THAT(reset.message, HasSubstr("y of block 'position' is nan after 0 control steps"));
  const Faults diverged = Play("TroubledDiverged", FaultCause::kDiverged, 300);
  EXPECT_GT(diverged.faulty, 2);
  EXPECT_LT(diverged.faulty, 25) << "the episodes after it are well";
  EXPECT_THAT(diverged.message, HasSubstr("task TroubledDiverged: the model: the simulation "
                                          "diverged"));
  const Faults reward = Play("TroubledReward", FaultCause::kReward, 300);
  EXPECT_GT(reward.faulty, 2);
  EXPECT_LT(reward.faulty, 25);
  EXPECT_THAT(reward.message, HasSubstr("the reward is nan after 6 control steps"));
}

TEST(Troubled, AnEvaluationCountsFaultyEpisodesAsFailed) {
  for (const char* task : {"TroubledSensor", "TroubledReset", "TroubledDiverged"}) {
    ConfigOf(task);
    const auto result = actor::PlayRandom({.task = task, .episodes = 200}, [] { return false; });
    const auto& aggregate = result.at("aggregate");
    const int faulty = aggregate.at("faulty_episodes");
    EXPECT_GT(faulty, 1) << task;
    EXPECT_LT(faulty, 20) << task;
    EXPECT_EQ(result.at("failures").at("not_finite"), faulty);
    int seen = 0, failed = 0;
    for (const auto& episode : result.at("episodes")) {
      failed += episode.at("success") == false;
      if (!episode.contains("fault")) continue;
      ++seen;
      EXPECT_EQ(episode.at("success"), false);
      EXPECT_EQ(episode.at("failure"), "not_finite");
      EXPECT_LT(episode.at("length"), 20);
    }
    EXPECT_EQ(seen, faulty);
    int counted = 0;
    for (const auto& [cause, count] : result.at("failures").items()) counted += count.get<int>();
    EXPECT_EQ(counted, failed) << "every failure has one cause";
    EXPECT_THAT(actor::RandomText(result), HasSubstr("ended at a number that is not finite"));
  }
}

TEST(Troubled, WhenEveryEpisodeIsFaultyAnEvaluationSaysSo) {
  ConfigOf("TroubledAlways");
  const auto result =
      actor::PlayRandom({.task = "TroubledAlways", .episodes = 40}, [] { return false; });
  EXPECT_EQ(result.at("aggregate").at("faulty_episodes"), 40);
  EXPECT_EQ(result.at("aggregate").at("success_rate"), 0);
  EXPECT_EQ(result.at("aggregate").at("length_mean"), 5);
  for (const auto& point : result.at("success_by_threshold")) {
    EXPECT_EQ(point.at("success_rate"), 0) << "wherever they ended";
  }
}

TEST(Troubled, CamerasOfTheModelCanBeNamed) {
  Config config = ConfigOf("TroubledSensor");
  config.observation.pixels = true;
  config.observation.height = config.observation.width = 24;
  config.observation.cameras = {"overhead", "top"};
  const auto render = MakeRenderContext(config.observation);
  EXPECT_EQ(MakeEnvironment(config, render)->spec().cameras, config.observation.cameras);
  config.observation.cameras = {"behind"};
  EXPECT_THAT(UsageMessage([&] { MakeEnvironment(config, render); }),
              HasSubstr("unknown camera 'behind' (observation.cameras); cameras of this task: top, "
                        "overhead, low"));
}

TEST(Troubled, ATaskWithoutTheDefaultCamerasIsSeenThroughItsFirst) {
  Config config = ConfigOf("TroubledSensor");
  config.observation.pixels = true;
  config.observation.height = config.observation.width = 24;
  const auto render = MakeRenderContext(config.observation);
  EXPECT_EQ(MakeEnvironment(config, render)->spec().cameras, std::vector<std::string>{"top"});
  config.task = "TroubledCamera";
  EXPECT_EQ(MakeEnvironment(config, render)->spec().cameras, std::vector<std::string>{"overhead"})
      << "the world lists none, the model does";
  // A default camera that the task lacks is not mixed with others.
  config.observation.custom_cameras["front"] = {{0, 0, 0}, 1, 0, -30};
  EXPECT_EQ(MakeEnvironment(config, render)->spec().cameras, std::vector<std::string>{"overhead"});
  config.observation.custom_cameras["side"] = {{0, 0, 0}, 1, 90, -30};
  EXPECT_EQ(MakeEnvironment(config, render)->spec().cameras,
            (std::vector<std::string>{"front", "side"}));
}

TEST(Troubled, AModelFileLiesBesideItsLibrary) {
  ConfigOf("TroubledSensor");
  WorldOptions options;
  EXPECT_EQ(options.ModelOr("model/arm.xml"), "model/arm.xml") << "of a built-in world";
  options.task_folder = "/tasks";
  EXPECT_EQ(options.ModelOr("model/arm.xml"), "/tasks/model/arm.xml");
  options.model = "other.xml";
  EXPECT_EQ(options.ModelOr("model/arm.xml"), "other.xml") << "the user's goes first";
  static std::string folder;
  AddWorld("Looks", [](const WorldOptions& given) -> std::unique_ptr<World> {
    folder = given.task_folder;
    return nullptr;
  });
  UsageMessage([] { MakeWorld("Looks", {}); });
  EXPECT_EQ(folder, "") << "added by the program itself";
}

}  // namespace
}  // namespace shoal::worlds
