// SPDX-License-Identifier: Apache-2.0
#include "common/tasks/hopper_tasks.h"

#include <string>

namespace shoal::tasks {
namespace {

Component Torque(const std::string& joint) {
  return {joint, "", "torque at the " + joint + "'s joint, 1 = 200 N m", -1, 1};
}

// All positions except the horizontal one, on which nothing depends, then all velocities.
Block Observation() {
  return {"observation",
          {{"torso_z", "m", "height of the torso"},
           {"torso_pitch", "rad", "lean of the torso, 0 = upright"},
           {"thigh", "rad", "angle of the thigh's joint"},
           {"leg", "rad", "angle of the leg's joint"},
           {"foot", "rad", "angle of the foot's joint"},
           {"torso_velocity_x", "m/s", "forward velocity of the torso"},
           {"torso_velocity_z", "m/s", "upward velocity of the torso"},
           {"torso_pitch_velocity", "rad/s", "rate of the torso's lean"},
           {"thigh_velocity", "rad/s", "rate of the thigh's joint"},
           {"leg_velocity", "rad/s", "rate of the leg's joint"},
           {"foot_velocity", "rad/s", "rate of the foot's joint"}}};
}

Task HopperTask(const std::string& name, int episode_length, const std::string& bonus) {
  Task::Description description;
  description.name = description.world = name;
  description.episode_length = episode_length;
  description.action = {Torque("thigh"), Torque("leg"), Torque("foot")};
  description.observation = {Observation()};
  description.physics_reward = "forward velocity in m/s + " + bonus +
                               " - 0.001 |action|^2; ends below 0.7 m or leaning by 0.2 rad";
  return Task(std::move(description));
}

}  // namespace

std::vector<Task> HopperTasks() {
  constexpr const char* kAlways = "1";
  constexpr const char* kWhileHealthy = "1 unless it ends";
  return {HopperTask("Hopper-v4", 1000, kAlways), HopperTask("Hopper-v5", 1000, kWhileHealthy),
          HopperTask("CustomHopper-source", 500, kAlways),
          HopperTask("CustomHopper-target", 500, kAlways)};
}

}  // namespace shoal::tasks
