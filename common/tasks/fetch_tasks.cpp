#include "common/tasks/fetch_tasks.h"

#include <string>

namespace shoal::tasks {
namespace {

constexpr int kEpisodeLength = 50;
constexpr double kDistanceThreshold = 0.05;

Block PositionBlock(const std::string& name, const std::string& what) {
  return {name,
          {{"x", "m", what + ", x in the world"},
           {"y", "m", what + ", y in the world"},
           {"z", "m", what + ", height above the floor"}}};
}

// Velocities are those of one env step: metres moved in the 0.04 s of a step at the present speed.
Block ReachObservation() {
  return {"observation",
          {{"grip_x", "m", "point between the fingers, x in the world"},
           {"grip_y", "m", "point between the fingers, y in the world"},
           {"grip_z", "m", "point between the fingers, height above the floor"},
           {"right_finger", "m", "opening of the right finger; held shut"},
           {"left_finger", "m", "opening of the left finger; held shut"},
           {"grip_velocity_x", "m/step", "velocity of the point between the fingers, x"},
           {"grip_velocity_y", "m/step", "velocity of the point between the fingers, y"},
           {"grip_velocity_z", "m/step", "velocity of the point between the fingers, z"},
           {"right_finger_velocity", "m/step", "velocity of the right finger"},
           {"left_finger_velocity", "m/step", "velocity of the left finger"}}};
}

// Each in [-1, 1]: the gripper is pulled towards 5 cm times the number, and lags behind.
std::vector<Component> Action() {
  return {{"dx", "", "moves the gripper along x, 1 = towards 5 cm further", -1, 1},
          {"dy", "", "moves the gripper along y, 1 = towards 5 cm further", -1, 1},
          {"dz", "", "moves the gripper up, 1 = towards 5 cm further", -1, 1},
          {"gripper", "", "1 opens and -1 shuts the fingers; no effect while they are held shut",
           -1, 1}};
}

Task FetchTask(const std::string& world, Block observation, RewardKind reward) {
  Task::Description description;
  description.name = world + (reward == RewardKind::kDense ? "Dense" : "");
  description.world = world;
  description.episode_length = kEpisodeLength;
  description.action = Action();
  description.observation = std::move(observation);
  description.achieved_goal = PositionBlock("achieved_goal", "point between the fingers");
  description.desired_goal = PositionBlock("desired_goal", "target");
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
