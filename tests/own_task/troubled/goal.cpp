// SPDX-License-Identifier: Apache-2.0
// Goal halves of tasks with faulty physics halves: a point of a plane, pushed to a goal.
#include <string>

#include "common/tasks/task_registry.h"

namespace {

using shoal::tasks::Block;

void Add(const char* name, bool goals = true, int actions = 2) {
  shoal::tasks::Task::Description task;
  task.name = name;
  task.world = name;
  task.episode_length = 20;
  for (int i = 0; i < actions; ++i) task.action.push_back({"push_" + std::to_string(i)});
  task.observation = {{"position", {{"x", "m"}, {"y", "m"}}},
                      {"velocity", {{"velocity_x", "m/s"}, {"velocity_y", "m/s"}}}};
  if (goals) {
    task.achieved_goal = {"achieved_goal", {{"x", "m"}, {"y", "m"}}};
    task.desired_goal = {"desired_goal", {{"x", "m"}, {"y", "m"}}};
    task.reward = shoal::tasks::RewardKind::kDense;
    task.distance_threshold = 0.05;
  }
  shoal::tasks::AddTask(shoal::tasks::Task(task));
}

}  // namespace

extern "C" void ShoalRegisterGoals() {
  for (const char* name :
       {"TroubledLong", "TroubledShort", "TroubledConstant", "TroubledSensor", "TroubledAlways",
        "TroubledReset", "TroubledDiverged", "TroubledTalk", "TroubledCamera", "TroubledNothing"}) {
    Add(name);
  }
  Add("TroubledReward", /*goals=*/false);
  Add("TroubledControls", /*goals=*/true, /*actions=*/3);
}
