// SPDX-License-Identifier: Apache-2.0
// Many actor processes on one replay server: time until all are discovered, cost of a transition.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "common/config/run_config.h"

namespace shoal::bench {

struct ManyActorsOptions {
  std::filesystem::path programs;  // folder of shoal-replay and shoal-fake-actor
  std::filesystem::path folder;    // an empty one
  int actors = 4;
  double steps_per_second = 50;  // of each actor
  double seconds = 10;           // measured, after all are found
  // Real actors of this run in place of those that cost nothing but time, and what they act by, as
  // safetensors. Their number is that above.
  std::optional<RunConfig> run{};
  std::string weights{};
};

// Config of a run without a learner, whose actors never wait.
RunConfig UnlearnedRun(int actors);

struct ManyActorsFigures {
  int actors = 0;
  // From the last actor's start until the replay has answered every one of them, and from then on
  // which of it was starting programs.
  double found_seconds = 0, start_seconds = 0;
  double transitions_per_second = 0;        // stored, resets included
  double env_steps_per_second = 0;          // of them the steps
  double replay_us_per_transition = 0;      // CPU time of the replay server
  double actor_us_per_transition = 0;       // CPU time of all actors
  uint64_t made = 0, stored = 0, lost = 0;  // the account, which balances
};

// Throws Error when actors are not found, or end badly, or the account does not balance.
ManyActorsFigures MeasureManyActors(const ManyActorsOptions& options);

}  // namespace shoal::bench
