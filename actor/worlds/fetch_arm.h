// SPDX-License-Identifier: Apache-2.0
// The robot that all Fetch tasks share: its set-up, the effect of actions, its sensors.
//
// The arm has no motors: a weld pulls the gripper towards a mocap body, and an action places the
// mocap body relative to the gripper's position. The arm therefore follows with a lag, and each
// step turns the gripper a little back to "down".
//
// Follows Gymnasium-Robotics' Fetch environments, v4, including the order of engine calls.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "actor/worlds/fetch_weld.h"
#include "actor/worlds/world.h"

namespace shoal::worlds {

struct FetchArmSetup {
  std::array<double, 3> base{};     // positions of slides x, y, z at the start, m
  double gripper_extra_height = 0;  // above the table's working height, m
  bool block_gripper = true;        // keeps the fingers shut
};

// Moves the model and state of a world. A FetchArm is a member of this world and borrows both.
class FetchArm {
 public:
  static constexpr int kEngineStepsPerEnvStep = 20;

  // Throws Error if the model lacks an element; the message names the element.
  FetchArm(World* world, const FetchArmSetup& setup, Physics physics);

  // Moves the gripper to the start position of episodes and keeps this initial state. Call it once,
  // after the model is loaded and an object is placed.
  void SetUp();
  // Position of the grip site in m after SetUp. The value is one engine step old.
  const std::array<double, 3>& initial_grip() const { return initial_grip_; }

  // Restores the initial state. All other data (mocap pose, solver warm start) gets the values of
  // newly made data.
  void RestoreInitialState();

  // Applies an action. action[0..2]: displacement in units of 5 cm; action[3]: fingers, ignored
  // while blocked. The caller then advances the engine by kEngineStepsPerEnvStep and calls
  // FinishStep.
  void Act(std::span<const double> action);
  // Shuts the fingers of a blocked gripper again and updates positions.
  void FinishStep();

  // Moves the gripper for pictures of goals. The engine runs until the grip site is within 1 mm of
  // `position` (m), but for at most 20 env steps. Afterwards each finger is `opening` m from the
  // middle, the arm is at rest, and positions are up to date.
  void MoveTo(const std::array<double, 3>& position, double opening);

  // Position of the grip site in m.
  std::array<double, 3> GripPosition() const;
  // Linear velocity of the grip site times the duration of an env step, m per env step.
  std::array<double, 3> GripVelocity() const;
  // Positions of the finger joints (right, left) in m.
  std::array<double, 2> Fingers() const;
  // Velocities of the finger joints (right, left) times the duration of an env step.
  std::array<double, 2> FingerVelocities() const;
  // Duration of an env step: 0.04 s.
  double StepSeconds() const;

 private:
  void FindMotors();

  World* world_;
  FetchArmSetup setup_;
  int grip_site_, gripper_body_, mocap_;
  std::array<int, 2> finger_position_, finger_velocity_;  // (right, left), indices in qpos, qvel
  std::array<int, 3> base_position_;                      // indices of the slides in qpos
  std::vector<int> motor_position_;  // index in qpos of the joint of each actuator
  std::array<double, 3> initial_grip_{};
  double initial_time_ = 0;
  std::vector<double> initial_qpos_, initial_qvel_;
};

}  // namespace shoal::worlds
