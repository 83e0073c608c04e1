// SPDX-License-Identifier: Apache-2.0
// A recorded trajectory of the original Fetch environments in the format vrl-ref-1, for comparison
// with Shoal's physics.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace shoal::worlds {

constexpr const char* kReferenceFormat = "vrl-ref-1";

// The state right after the reset or after a step. Positions in m, velocities in the engine's
// units.
struct ReferenceState {
  std::vector<double> observation;  // (10) Reach, (25) with an object
  std::array<double, 3> achieved_goal{};
  std::vector<double> qpos, qvel;  // in the order of joint_names; a free joint has 7 and 6 numbers
  std::array<double, 4> grip_quaternion{};
  int contacts = 0;
};

struct ReferenceStep {
  std::vector<double> action;  // (4), each in [-1, 1]
  ReferenceState state;
  double distance = 0;
  double reward_sparse = 0, reward_dense = 0;
  bool success = false;
};

struct ReferenceTrajectory {
  std::string environment;  // "FetchReach-v4"
  std::string task;         // "FetchReach"
  std::string sequence;     // name of the action sequence: "random0"
  bool has_object = false;
  std::array<double, 3> initial_grip{};
  double table_height = 0;            // z of the object's site after the set-up; 0 without object
  std::array<double, 2> object_xy{};  // at the reset; 0 without object
  std::array<double, 3> desired_goal{};
  std::vector<std::string> joint_names;
  ReferenceState reset;
  std::vector<ReferenceStep> steps;
};

// Reads a trajectory. Throws Error naming the file and the key if the file is unreadable, is not
// JSON or has another format; if the environment cannot be replayed (the message lists the
// supported environments); or if a value is missing, ill-typed, of the wrong length, not finite or
// (for actions) outside [-1, 1].
ReferenceTrajectory ReadReference(const std::filesystem::path& path);

}  // namespace shoal::worlds
