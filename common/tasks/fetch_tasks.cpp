// SPDX-License-Identifier: Apache-2.0
#include "common/tasks/fetch_tasks.h"

#include <string>

namespace shoal::tasks {
namespace {

constexpr int kFetchEpisodeLength = 50;
constexpr double kDistanceThreshold = 0.05;

using Components = std::vector<Component>;

// Three numbers of one quantity: x, y, z in the world.
Components Vector(const std::string& prefix, const std::string& unit, const std::string& what) {
  return {{prefix + "x", unit, what + ", x in the world"},
          {prefix + "y", unit, what + ", y in the world"},
          {prefix + "z", unit, what + ", z in the world (up)"}};
}

// The same as a block. The names of its components begin with the block's name.
Block VectorBlock(const std::string& name, const std::string& unit, const std::string& what) {
  return {name, Vector(name + "_", unit, what)};
}

Components Fingers(bool held_shut) {
  const std::string note = held_shut ? "; held shut" : "";
  return {{"right_finger", "m", "opening of the right finger" + note},
          {"left_finger", "m", "opening of the left finger" + note}};
}

Components FingerVelocities() {
  return {{"right_finger_velocity", "m/step", "velocity of the right finger"},
          {"left_finger_velocity", "m/step", "velocity of the left finger"}};
}

constexpr const char* kGrip = "point between the fingers";

// Velocities are per env step: the motion in the 0.04 s of a step at the present speed.
std::vector<Block> ReachObservation() {
  return {VectorBlock("grip", "m", kGrip),
          {"fingers", Fingers(/*held_shut=*/true)},
          VectorBlock("grip_velocity", "m/step", "velocity of the point between the fingers"),
          {"finger_velocities", FingerVelocities()}};
}

std::vector<Block> ObjectObservation(bool fingers_held_shut) {
  return {VectorBlock("grip", "m", kGrip),
          VectorBlock("object", "m", "object's centre"),
          VectorBlock("object_from_grip", "m", "object's centre seen from between the fingers"),
          {"fingers", Fingers(fingers_held_shut)},
          VectorBlock("object_angle", "rad", "object's Euler angle, jumping at +-pi"),
          VectorBlock("object_velocity_from_grip", "m/step",
                      "velocity of the object less that of the point between the fingers"),
          VectorBlock("object_angular_velocity", "rad/step", "angular velocity of the object"),
          VectorBlock("grip_velocity", "m/step", "velocity of the point between the fingers"),
          {"finger_velocities", FingerVelocities()}};
}

// Each number is in [-1, 1]. The gripper is pulled towards 5 cm times the number, and lags behind.
Components Action(bool fingers_held_shut) {
  return {{"dx", "", "moves the gripper along x, 1 = towards 5 cm further", -1, 1},
          {"dy", "", "moves the gripper along y, 1 = towards 5 cm further", -1, 1},
          {"dz", "", "moves the gripper up, 1 = towards 5 cm further", -1, 1},
          {"gripper", "",
           fingers_held_shut ? "no effect: the fingers are held shut"
                             : "1 opens and -1 shuts the fingers, with full force",
           -1, 1}};
}

struct Family {
  const char* world;
  bool has_object, fingers_held_shut;
};

Task FetchTask(const Family& family, RewardKind reward) {
  const bool shut = family.fingers_held_shut;
  Task::Description description;
  description.name = family.world + std::string(reward == RewardKind::kDense ? "Dense" : "");
  description.world = family.world;
  description.episode_length = kFetchEpisodeLength;
  description.action = Action(shut);
  description.observation = family.has_object ? ObjectObservation(shut) : ReachObservation();
  description.achieved_goal = {"achieved_goal",
                               Vector("", "m", family.has_object ? "object's centre" : kGrip)};
  description.desired_goal = {"desired_goal", Vector("", "m", "target")};
  description.reward = reward;
  description.distance_threshold = kDistanceThreshold;
  return Task(std::move(description));
}

}  // namespace

std::vector<Task> FetchTasks() {
  std::vector<Task> tasks;
  for (const Family& family :
       {Family{"FetchReach", false, true}, Family{"FetchPush", true, true},
        Family{"FetchSlide", true, true}, Family{"FetchPickAndPlace", true, false}}) {
    tasks.push_back(FetchTask(family, RewardKind::kSparse));
    tasks.push_back(FetchTask(family, RewardKind::kDense));
  }
  return tasks;
}

}  // namespace shoal::tasks
