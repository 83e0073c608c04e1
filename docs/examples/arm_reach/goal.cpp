// SPDX-License-Identifier: Apache-2.0
// Goal half of a two-link arm that reaches for a point of its plane.
#include "common/tasks/task_registry.h"

extern "C" void ShoalRegisterGoals() {
  shoal::tasks::Task::Description task;
  task.name = "ArmReachDense";
  task.world = "ArmReach";
  task.episode_length = 50;
  task.action = {{"shoulder", "", "torque, 1 = 0.4 N m", -1, 1},
                 {"elbow", "", "torque, 1 = 0.2 N m", -1, 1}};
  task.observation = {{"angles", {{"shoulder", "rad"}, {"elbow", "rad"}}},
                      {"speeds", {{"shoulder_speed", "rad/s"}, {"elbow_speed", "rad/s"}}}};
  task.achieved_goal = {"achieved_goal", {{"x", "m", "the tip"}, {"y", "m", "the tip"}}};
  task.desired_goal = {"desired_goal", {{"x", "m", "target"}, {"y", "m", "target"}}};
  task.reward = shoal::tasks::RewardKind::kDense;
  task.distance_threshold = 0.05;
  shoal::tasks::AddTask(shoal::tasks::Task(task));
}
