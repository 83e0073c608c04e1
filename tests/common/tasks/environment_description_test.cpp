// SPDX-License-Identifier: Apache-2.0
#include "common/tasks/environment_description.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/tasks/task_registry.h"
#include "tests/support/error_message.h"

namespace shoal::tasks {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

json Described() {
  return json::parse(R"({
    "schema": "shoal-environment-1", "id": "lab:Arm-v1", "task": "Arm-v1", "episode_steps": 50,
    "action": {"shape": [2], "dtype": "float32", "low": -1, "high": [1, 3]},
    "observation": [
      {"name": "robot.arm", "shape": [2, 2], "dtype": "float64", "low": null, "high": null},
      {"name": "camera", "shape": [64, 48, 3], "dtype": "uint8", "low": 0, "high": 255}],
    "success": true})");
}

std::string RefusalOf(const json& described) {
  return UsageMessage([&] { EnvironmentFromJson(described); });
}

TEST(EnvironmentDescription, ReadsBoundsForAllElementsAndForEach) {
  const EnvironmentDescription environment = EnvironmentFromJson(Described());
  EXPECT_EQ(environment.action.Low(1), -1);
  EXPECT_EQ(environment.action.High(1), 3);
  EXPECT_TRUE(std::isinf(environment.observation[0].Low(3)));
  EXPECT_LT(environment.observation[0].Low(3), 0);
  EXPECT_GT(environment.observation[0].High(0), 0);
  EXPECT_EQ(environment.observation[0].size(), 4);
}

TEST(EnvironmentDescription, IsTheSameAfterARoundTrip) {
  EnvironmentDescription environment = EnvironmentFromJson(Described());
  EXPECT_EQ(EnvironmentFromJson(ToJson(environment)), environment);
  environment.no_goal = "compute_reward is missing";
  EXPECT_EQ(EnvironmentFromJson(ToJson(environment)), environment);
}

TEST(EnvironmentDescription, ItsTaskHasTheBlocksButNoImages) {
  const Task task = TaskOf(EnvironmentFromJson(Described()));
  EXPECT_EQ(task.name(), "Arm-v1");
  EXPECT_EQ(task.episode_length(), 50);
  EXPECT_EQ(task.action_size(), 2);
  ASSERT_EQ(task.state_blocks().size(), 1u);
  EXPECT_EQ(task.state_blocks()[0].name, "robot.arm");
  EXPECT_EQ(task.goal_size(), 0);
  EXPECT_TRUE(task.has_success());
  json silent = Described();
  silent["success"] = false;
  silent["episode_steps"] = 0;
  EXPECT_FALSE(TaskOf(EnvironmentFromJson(silent)).has_success());
  EXPECT_GT(TaskOf(EnvironmentFromJson(silent)).episode_length(), 1'000'000) << "no time limit";
}

TEST(EnvironmentDescription, AVerifiedGoalMakesATaskWithGoals) {
  json described = Described();
  for (const char* name : {"achieved_goal", "desired_goal"}) {
    described["observation"].push_back({{"name", name},
                                        {"shape", {3}},
                                        {"dtype", "float64"},
                                        {"low", nullptr},
                                        {"high", nullptr}});
  }
  EXPECT_EQ(TaskOf(EnvironmentFromJson(described)).goal_size(), 0) << "its reward is unknown";
  described["goal"] = {{"reward", "dense"}, {"threshold", 0.05}};
  const Task task = TaskOf(EnvironmentFromJson(described));
  EXPECT_EQ(task.goal_size(), 3);
  EXPECT_EQ(task.reward_kind(), RewardKind::kDense);
  EXPECT_EQ(task.distance_threshold(), 0.05);
  EXPECT_EQ(task.state_blocks().size(), 1u);
}

TEST(EnvironmentDescription, ImagesHaveTheirChannelsFirstOrLast) {
  const auto layout = [](std::vector<int> shape, ElementType type = ElementType::kUint8) {
    return ImageLayoutOf({.name = "view", .shape = std::move(shape), .type = type});
  };
  EXPECT_EQ(layout({64, 48, 3}), (ImageLayout{.height = 64, .width = 48, .channels = 3}));
  EXPECT_EQ(layout({3, 64, 48}),
            (ImageLayout{.height = 64, .width = 48, .channels = 3, .channels_first = true}));
  EXPECT_EQ(layout({64, 48}), (ImageLayout{.height = 64, .width = 48, .channels = 1}));
  EXPECT_EQ(layout({128}), std::nullopt) << "numbers in bytes";
  EXPECT_EQ(layout({64, 48, 3}, ElementType::kFloat32), std::nullopt);
  for (const std::vector<int>& shape : {std::vector{4, 64, 48, 3}, {64, 48, 12}, {4, 48, 3}}) {
    EXPECT_THAT(UsageMessage([&] { layout(shape); }),
                AllOf(HasSubstr("'view'"), HasSubstr("observation.stack")));
  }
}

TEST(EnvironmentDescription, WhatCannotBeTrainedIsRefusedByName) {
  json described = Described();
  described["action"]["high"] = {1, nullptr};
  EXPECT_THAT(RefusalOf(described), HasSubstr("number 1 of the action has the bounds [-1, inf]"));
  described = Described();
  described["action"]["high"] = {1, 2, 3};
  EXPECT_THAT(RefusalOf(described), HasSubstr("'action' has 2 elements and 3 bounds"));
  described = Described();
  described["observation"][1]["name"] = "robot.arm";
  EXPECT_THAT(RefusalOf(described), HasSubstr("two arrays of the observation have the name"));
  described = Described();
  described["observation"][0]["dtype"] = "complex64";
  EXPECT_THAT(RefusalOf(described), AllOf(HasSubstr("complex64"), HasSubstr("float32")));
  described = Described();
  described.erase("action");
  EXPECT_THAT(RefusalOf(described), HasSubstr("'action' not found"));
  described = Described();
  described["observation"] = json::array();
  EXPECT_THAT(RefusalOf(described), HasSubstr("has no arrays"));
  described = Described();
  described["schema"] = "shoal-environment-0";
  EXPECT_THAT(RefusalOf(described), HasSubstr("shoal-environment-1"));
}

TEST(EnvironmentDescription, TasksAreNamedAfterTheEnvironment) {
  EXPECT_EQ(TaskNameOf("Pendulum-v1"), "Pendulum-v1");
  EXPECT_EQ(TaskNameOf("ALE/Pong-v5"), "ALE-Pong-v5");
  EXPECT_EQ(TaskNameOf("package.module:Arm"), "Arm");
  EXPECT_EQ(TaskNameOf("/home/me/my_env.py:Arm"), "my_env.Arm");
  EXPECT_EQ(TaskNameOf("gymnasium:Hopper-v5"), "environment.Hopper-v5") << "Shoal has a Hopper-v5";
}

TEST(EnvironmentDescription, ATaskIsAddedOnce) {
  json described = Described();
  described["task"] = "Added-v0";
  AddEnvironmentTask(described.dump());
  AddEnvironmentTask(described.dump());
  AddEnvironmentTask("");
  EXPECT_EQ(FindTask("Added-v0").episode_length(), 50);
  EXPECT_EQ(TaskNameOf("Added-v0"), "Added-v0") << "its own name is not taken";
}

}  // namespace
}  // namespace shoal::tasks
