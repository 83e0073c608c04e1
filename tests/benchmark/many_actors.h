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
  std::filesystem::path folder;    // an empty folder
  int actors = 4;
  double steps_per_second = 50;  // of each actor
  double seconds = 10;           // length of the measurement, after all actors have been found
  // Run and policy weights (safetensors) of real actors. Empty: the actors are shoal-fake-actor.
  std::optional<RunConfig> run{};
  std::string weights{};
};

// Configuration of a run without a learner, whose actors never wait.
RunConfig UnlearnedRun(int actors);

struct ManyActorsFigures {
  int actors = 0;
  // start_seconds: time to start all actors. found_seconds: time from then until the replay has
  // answered every actor.
  double found_seconds = 0, start_seconds = 0;
  double transitions_per_second = 0;        // stored records per second, including resets
  double env_steps_per_second = 0;          // stored steps per second
  double replay_us_per_transition = 0;      // CPU time of the replay server
  double actor_us_per_transition = 0;       // CPU time of all actors
  uint64_t made = 0, stored = 0, lost = 0;  // numbers of records in the run's account
};

// Throws Error if actors are not found or fail, or if the numbers of records do not balance.
ManyActorsFigures MeasureManyActors(const ManyActorsOptions& options);

}  // namespace shoal::bench
