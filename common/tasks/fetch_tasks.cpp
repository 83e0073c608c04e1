#include "common/tasks/fetch_tasks.h"

#include <string>

namespace shoal::tasks {
namespace {

constexpr int kEpisodeLength = 50;
constexpr double kDistanceThreshold = 0.05;

Block PositionBlock(const std::string& name) {
  return {name, {{"x", "m"}, {"y", "m"}, {"z", "m"}}};
}

// Velocities are those of one env step: metres moved in the 0.04 s of a step at the present speed.
Block ReachObservation() {
  return {"observation",
          {{"grip_x", "m"},
           {"grip_y", "m"},
           {"grip_z", "m"},
           {"right_finger", "m"},
           {"left_finger", "m"},
           {"grip_velocity_x", "m/step"},
           {"grip_velocity_y", "m/step"},
           {"grip_velocity_z", "m/step"},
           {"right_finger_velocity", "m/step"},
           {"left_finger_velocity", "m/step"}}};
}

Task FetchTask(const std::string& world, Block observation, RewardKind reward) {
  Task::Description description;
  description.name = world + (reward == RewardKind::kDense ? "Dense" : "");
  description.world = world;
  description.episode_length = kEpisodeLength;
  description.action = {{"dx", ""}, {"dy", ""}, {"dz", ""}, {"gripper", ""}};
  description.observation = std::move(observation);
  description.achieved_goal = PositionBlock("achieved_goal");
  description.desired_goal = PositionBlock("desired_goal");
  description.reward = reward;
  description.distance_threshold = kDistanceThreshold;
  return Task(std::move(description));
}

}  // namespace

std::vector<Task> FetchTasks() {
  return {FetchTask("FetchReach", ReachObservation(), RewardKind::kSparse),
          FetchTask("FetchReach", ReachObservation(), RewardKind::kDense)};
}

}  // namespace shoal::tasks
