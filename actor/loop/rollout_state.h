// SPDX-License-Identifier: Apache-2.0
// State of an actor in lockstep when its run stopped. A resumed run continues from it bit for bit.
// It holds the running episodes as lists of actions, which the successor plays again: physics
// depends on the episode's random stream and the actions alone.
//
// File RUN/made/actor-ID.rollout, JSON (schema shoal-rollout-3) with a CRC-32 of itself. An actor
// writes it when it stops in order, and its successor removes it. A killed actor leaves none.
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
  bool owes = false;              // of a vector step under way it has not made its step
  ActionSelector::Noise noise{};  // now
  std::vector<float> actions;     // (length, A) of the running episode

  bool operator==(const EpisodeState&) const = default;
};

struct RolloutState {
  uint64_t session = 0;                // goes on: the replay joins records of one session only
  uint64_t made = 0;                   // records, all of them stored
  uint64_t env_steps = 0;              // of the actor since the run's start
  std::vector<EpisodeState> episodes;  // per environment

  bool operator==(const RolloutState&) const = default;
};

// Throws Error when it cannot be written.
void WriteRolloutState(const std::filesystem::path& run, uint32_t actor, const RolloutState& state);

// The state a predecessor left; none when there is none. Throws Error (usage) naming a damaged
// file.
std::optional<RolloutState> ReadRolloutState(const std::filesystem::path& run, uint32_t actor);
// The same, once: removes the file.
std::optional<RolloutState> TakeRolloutState(const std::filesystem::path& run, uint32_t actor);

}  // namespace shoal::actor
