// Goal half: what is observed, what is a goal, what earns reward. No physics.
#include "common/tasks/task_registry.h"

namespace {

shoal::tasks::Task GoalHalf() {
  shoal::tasks::Task::Description task;
  task.name = "PointReachDense";
  task.world = "PointReach";
  task.episode_length = 40;
  task.action = {{"push_x", "", "force along x, 1 = 1 N", -1, 1},
                 {"push_y", "", "force along y, 1 = 1 N", -1, 1}};
  task.observation = {
      {"position", {{"x", "m", "position of the point"}, {"y", "m", "position of the point"}}},
      {"velocity",
       {{"velocity_x", "m/s", "velocity of the point"},
        {"velocity_y", "m/s", "velocity of the point"}}}};
  task.achieved_goal = {"achieved_goal",
                        {{"x", "m", "position of the point"}, {"y", "m", "position of the point"}}};
  task.desired_goal = {"desired_goal",
                       {{"x", "m", "target", -0.3, 0.3}, {"y", "m", "target", -0.3, 0.3}}};
  task.reward = shoal::tasks::RewardKind::kDense;
  task.distance_threshold = 0.05;
  return shoal::tasks::Task(task);
}

}  // namespace

extern "C" void ShoalRegisterGoals() { shoal::tasks::AddTask(GoalHalf()); }
