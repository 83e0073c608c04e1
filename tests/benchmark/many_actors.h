// Many actor processes on one replay server: how soon all are found, what a transition costs.
#pragma once

#include <cstdint>
#include <filesystem>

namespace shoal::bench {

struct ManyActorsOptions {
  std::filesystem::path programs;  // where shoal-replay and shoal-fake-actor are
  std::filesystem::path folder;    // an empty one
  int actors = 4;
  double steps_per_second = 50;  // of each actor
  double seconds = 10;           // measured, once all are found
};

struct ManyActorsFigures {
  int actors = 0;
  // From the last actor's start until the replay has answered every one of them, and from then on
  // which of it was starting programs.
  double found_seconds = 0, start_seconds = 0;
  double transitions_per_second = 0;        // stored
  double replay_us_per_transition = 0;      // CPU time of the replay server
  double actor_us_per_transition = 0;       // CPU time of all actors
  uint64_t made = 0, stored = 0, lost = 0;  // the account, which balances
};

// Throws Error when actors are not found, or end badly, or the account does not balance.
ManyActorsFigures MeasureManyActors(const ManyActorsOptions& options);

}  // namespace shoal::bench
