// SPDX-License-Identifier: Apache-2.0
#include "common/tasks/task_registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "common/base/error.h"

namespace shoal::tasks {
namespace {

using testing::HasSubstr;

TEST(TaskRegistry, NamesAreUniqueAndFindTheirTask) {
  std::set<std::string> seen;
  for (const std::string& name : TaskNames()) {
    EXPECT_TRUE(seen.insert(name).second) << name;
    EXPECT_EQ(FindTask(name).name(), name);
  }
  for (const char* name :
       {"FetchReach", "FetchPickAndPlaceDense", "Hopper-v4", "Hopper-v5", "CustomHopper-source",
        "CustomHopper-target", "cartpole_swingup", "reacher_easy", "cheetah_run",
        "ball_in_cup_catch", "finger_spin", "walker_walk"}) {
    EXPECT_TRUE(seen.contains(name)) << name;
  }
}

TEST(TaskRegistry, OnlyTasksWithGoalsKnowSuccess) {
  EXPECT_TRUE(FindTask("FetchReach").has_success());
  for (const char* name : {"Hopper-v5", "walker_walk"}) {
    EXPECT_EQ(FindTask(name).goal_size(), 0) << name;
    EXPECT_FALSE(FindTask(name).has_success()) << name;
  }
}

TEST(TaskRegistry, EpisodesAndRepeatsAreAsPublished) {
  const struct {
    const char* name;
    int control_steps, repeat, env_steps;
  } rows[] = {{"FetchReach", 50, 1, 50},
              {"Hopper-v5", 1000, 1, 1000},
              {"CustomHopper-source", 500, 1, 500},
              {"cartpole_swingup", 1000, 8, 125},
              {"reacher_easy", 1000, 4, 250},
              {"cheetah_run", 1000, 4, 250},
              {"ball_in_cup_catch", 1000, 4, 250},
              {"finger_spin", 1000, 2, 500},
              {"walker_walk", 1000, 2, 500}};
  for (const auto& row : rows) {
    const Task& task = FindTask(row.name);
    EXPECT_EQ(task.episode_length(), row.control_steps) << row.name;
    EXPECT_EQ(task.action_repeat(), row.repeat) << row.name;
    EXPECT_EQ(task.EnvStepsPerEpisode(task.action_repeat()), row.env_steps) << row.name;
  }
  EXPECT_EQ(FindTask("ball_in_cup_catch").EnvStepsPerEpisode(6), 167);
}

TEST(TaskRegistry, TasksWithoutGoalsHaveThePublishedSizes) {
  const struct {
    const char* name;
    int action, observation;
  } rows[] = {{"Hopper-v4", 3, 11},   {"cartpole_swingup", 1, 5},  {"reacher_easy", 2, 6},
              {"cheetah_run", 6, 17}, {"ball_in_cup_catch", 2, 8}, {"finger_spin", 2, 9},
              {"walker_walk", 6, 24}};
  for (const auto& row : rows) {
    EXPECT_EQ(FindTask(row.name).action_size(), row.action) << row.name;
    EXPECT_EQ(FindTask(row.name).observation().size(), row.observation) << row.name;
  }
}

TEST(TaskRegistry, EveryNumberSaysWhatItMeansAndActionsAreBounded) {
  for (const std::string& name : TaskNames()) {
    const Task& task = FindTask(name);
    for (const Component& axis : task.action()) {
      EXPECT_NE(axis.meaning, "") << name << " action " << axis.name;
      EXPECT_EQ(axis.low, -1) << name << " action " << axis.name;
      EXPECT_EQ(axis.high, 1) << name << " action " << axis.name;
    }
    for (const Block* block : {&task.observation(), &task.achieved_goal(), &task.desired_goal()}) {
      for (const Component& number : block->components) {
        EXPECT_NE(number.meaning, "") << name << " " << block->name << " " << number.name;
        EXPECT_LT(number.low, number.high) << name << " " << block->name << " " << number.name;
      }
    }
  }
}

TEST(TaskRegistry, AnUnknownTaskIsAUsageErrorThatListsTheTasks) {
  try {
    FindTask("FetchReech");
    FAIL() << "found a task that is not there";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    EXPECT_THAT(error.what(), HasSubstr("FetchReech"));
    EXPECT_THAT(error.what(), HasSubstr("FetchReach, FetchReachDense"));
  }
}

TEST(TaskRegistry, FetchReachIsDescribedAsPublished) {
  for (const char* name : {"FetchReach", "FetchReachDense"}) {
    const Task& task = FindTask(name);
    EXPECT_EQ(task.world(), "FetchReach");
    EXPECT_EQ(task.episode_length(), 50);
    EXPECT_EQ(task.action_size(), 4);
    EXPECT_EQ(task.observation().size(), 10);
    EXPECT_EQ(task.goal_size(), 3);
    EXPECT_EQ(task.distance_threshold(), 0.05);
  }
  EXPECT_EQ(FindTask("FetchReach").reward_kind(), RewardKind::kSparse);
  EXPECT_EQ(FindTask("FetchReachDense").reward_kind(), RewardKind::kDense);
}

}  // namespace
}  // namespace shoal::tasks
