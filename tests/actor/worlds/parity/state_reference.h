// SPDX-License-Identifier: Apache-2.0
// A recorded trajectory (format vrl-ref-1) of an environment without goals: Hopper or one of the
// Control Suite. Shoal's physics is compared with it.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace shoal::worlds {

// Right after the reset or a control step, in the engine's units.
struct StateSnapshot {
  std::vector<double> observation, qpos, qvel;
  int contacts = 0;
};

struct StateStep {
  std::vector<double> action;  // each in [-1, 1]
  StateSnapshot after;
  double reward = 0;  // of the environment; for Hopper that of Hopper-v5
  std::optional<double> reward_hopper_v4;
  std::optional<bool> healthy;  // Hopper
};

struct StateTrajectory {
  std::string environment;  // "Hopper", "walker_walk"
  std::string variant;      // Hopper: "gymnasium", "gymnasium_source", "custom_target" or "_source"
  std::string sequence;     // name of the action sequence: "random0"
  // The drawn state of a reset, before cheetah_run's settling.
  std::vector<double> drawn_qpos, drawn_qvel;
  std::optional<std::array<double, 2>> target;  // reacher_easy, m
  StateSnapshot reset;
  std::vector<StateStep> steps;
};

// "Hopper, cartpole_swingup, ...": values of the key `env` of such files.
std::string StateEnvironments();
bool IsStateEnvironment(const std::string& environment);

// Throws Error naming the file and the key: unreadable, not JSON, another format, an environment or
// variant that cannot be replayed, a key missing, ill-typed, of the wrong length, not finite or
// (actions) outside [-1, 1].
StateTrajectory ReadStateReference(const std::filesystem::path& path);

}  // namespace shoal::worlds
