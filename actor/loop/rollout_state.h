// SPDX-License-Identifier: Apache-2.0
// State of an actor in lockstep when its run stopped. A resumed run continues from the state bit
// for bit. The state holds the running episodes as lists of actions, which the next process
// replays: physics depends only on the episode's random stream and the actions.
//
// File RUN/made/actor-ID.rollout, JSON (schema shoal-rollout-3) with a CRC-32 of its content. An
// actor writes the file at an orderly stop, and the next process removes it. A killed actor leaves
// no file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "actor/acting/action_selector.h"

namespace shoal::actor {

struct EpisodeState {
  uint32_t episode = 0;
  bool running = false;
  int cut_after = 0;              // env steps; 0 = the episode is not cut short
  bool owes = false;              // the environment has not yet made its step of the vector step
  ActionSelector::Noise noise{};  // present state of the exploration
  std::vector<float> actions;     // (length, A) of the running episode

  bool operator==(const EpisodeState&) const = default;
};

struct RolloutState {
  uint64_t session = 0;    // of the actor; kept, as the replay joins records of one session
  uint64_t made = 0;       // number of records made; all of them are stored
  uint64_t env_steps = 0;  // of the actor since the run's start
  std::vector<EpisodeState> episodes;  // one per environment

  bool operator==(const RolloutState&) const = default;
};

// Writes the file. Throws Error if the file cannot be written.
void WriteRolloutState(const std::filesystem::path& run, uint32_t actor, const RolloutState& state);

// Reads the state of a previous process; empty if there is no file. If the file is damaged, throws
// Error (usage) naming the file.
std::optional<RolloutState> ReadRolloutState(const std::filesystem::path& run, uint32_t actor);
// Reads the state and removes the file.
std::optional<RolloutState> TakeRolloutState(const std::filesystem::path& run, uint32_t actor);

}  // namespace shoal::actor
