// SPDX-License-Identifier: Apache-2.0
// A recorded trajectory (format vrl-ref-1) of an environment without goals: Hopper or a task of the
// Control Suite. Tests compare Shoal's physics with the trajectory.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace shoal::worlds {

// State right after the reset or after a control step, in the engine's units.
struct StateSnapshot {
  std::vector<double> observation, qpos, qvel;
  int contacts = 0;
};

struct StateStep {
  std::vector<double> action;  // each in [-1, 1]
  StateSnapshot after;
  double reward = 0;  // the environment's reward; for Hopper, the reward of Hopper-v5
  std::optional<double> reward_hopper_v4;
  std::optional<bool> healthy;  // only Hopper
};

struct StateTrajectory {
  std::string environment;  // "Hopper", "walker_walk"
  std::string variant;      // Hopper: "gymnasium", "gymnasium_source", "custom_target" or "_source"
  std::string sequence;     // name of the action sequence: "random0"
  // The drawn state of a reset, before cheetah_run's settling.
  std::vector<double> drawn_qpos, drawn_qvel;
  std::optional<std::array<double, 2>> target;  // only reacher_easy, m
  StateSnapshot reset;
  std::vector<StateStep> steps;
};

// "Hopper, cartpole_swingup, ...": values of the key `env` of such files.
std::string StateEnvironments();
bool IsStateEnvironment(const std::string& environment);

// Throws Error naming the file and the key if the file is unreadable, is not JSON or has another
// format; if the environment or variant cannot be replayed; or if a value is missing, ill-typed, of
// the wrong length, not finite or (for actions) outside [-1, 1].
StateTrajectory ReadStateReference(const std::filesystem::path& path);

}  // namespace shoal::worlds
