// SPDX-License-Identifier: Apache-2.0
// The robot that all Fetch tasks share: how it is set up, how an action moves it, what it senses.
//
// The arm has no motors: a weld pulls the gripper towards a mocap body, and an action places the
// mocap body relative to where the gripper is. So the arm follows with a lag, and orientation is
// steered back to "down" a little every step.
//
// Behaviour of Gymnasium-Robotics' Fetch environments, v4, down to the order of engine calls.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "actor/worlds/fetch_weld.h"
#include "actor/worlds/world.h"

namespace shoal::worlds {

struct FetchArmSetup {
  std::array<double, 3> base{};     // slides x, y, z at the start, m
  double gripper_extra_height = 0;  // above the table's working height, m
  bool block_gripper = true;        // fingers held shut
};

// Lives inside the world whose model and state it moves; borrows both.
class FetchArm {
 public:
  static constexpr int kEngineStepsPerEnvStep = 20;

  // Throws Error naming what the model lacks.
  FetchArm(World* world, const FetchArmSetup& setup, Physics physics);

  // Once, after loading and placing an object: moves the gripper to where episodes start and keeps
  // that state.
  void SetUp();
  // Grip site in m, as the last of the setup's engine steps left it: one such step stale.
  const std::array<double, 3>& initial_grip() const { return initial_grip_; }

  // Back to the kept state: everything else (mocap pose, solver warm start) as in a fresh state.
  void RestoreInitialState();

  // action[0..2]: displacement in units of 5 cm; action[3]: fingers, ignored while blocked. After
  // this the caller advances the engine by kEngineStepsPerEnvStep and calls FinishStep.
  void Act(std::span<const double> action);
  // Shuts the fingers of a blocked gripper again and brings positions up to date.
  void FinishStep();

  // For pictures of goals: the engine runs until the grip site is within 1 mm of `position` (m), or
  // as near as it comes within 20 env steps, and the fingers then stand `opening` m from the
  // middle. At rest, positions up to date.
  void MoveTo(const std::array<double, 3>& position, double opening);

  // Grip site in m.
  std::array<double, 3> GripPosition() const;
  // Grip site's linear velocity times the length of an env step, m per env step.
  std::array<double, 3> GripVelocity() const;
  // (right, left): finger joints in m, and their velocities times the length of an env step.
  std::array<double, 2> Fingers() const;
  std::array<double, 2> FingerVelocities() const;
  // 0.04 s.
  double StepSeconds() const;

 private:
  void FindMotors();

  World* world_;
  FetchArmSetup setup_;
  int grip_site_, gripper_body_, mocap_;
  std::array<int, 2> finger_position_, finger_velocity_;  // (right, left) in qpos, qvel
  std::array<int, 3> base_position_;                      // slides in qpos
  std::vector<int> motor_position_;  // in qpos: of the joint that each actuator drives
  std::array<double, 3> initial_grip_{};
  double initial_time_ = 0;
  std::vector<double> initial_qpos_, initial_qvel_;
};

}  // namespace shoal::worlds
