// SPDX-License-Identifier: Apache-2.0
// Goal half of a task whose processes a test can make crash (physics.cpp).
#include "common/tasks/task_registry.h"

namespace {

shoal::tasks::Task GoalHalf() {
  shoal::tasks::Task::Description task;
  task.name = "CrashingPoint";
  task.world = "CrashingPoint";
  task.episode_length = 40;
  task.action = {{"push_x", "", "force along x, 1 = 1 N", -1, 1}};
  task.observation = {{"position", {{"x", "m", "position of the point"}}}};
  task.achieved_goal = {"achieved_goal", {{"x", "m", "position of the point"}}};
  task.desired_goal = {"desired_goal", {{"x", "m", "target", -0.3, 0.3}}};
  task.reward = shoal::tasks::RewardKind::kDense;
  task.distance_threshold = 0.05;
  return shoal::tasks::Task(task);
}

}  // namespace

extern "C" void ShoalRegisterGoals() { shoal::tasks::AddTask(GoalHalf()); }
