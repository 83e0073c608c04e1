// SPDX-License-Identifier: Apache-2.0
// Runs Shoal's real coordinator, replay, learner, evaluation actor and actors in simulated time
// with faults, and reports broken promises.
//
// Simulated parts: clock, threads, link (in memory), processes, failures of the disk, environments,
// the update, and the user who resumes the run. Real parts: all files, in a separate folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/simulation/blueprint.h"
#include "tests/simulation/fault.h"

namespace shoal::simulation {

struct Outcome {
  std::vector<std::string> violations;  // broken promises, one line each
  std::vector<std::string> story;       // events, as text
  uint64_t trace = 0;                   // equal for equal runs
  uint64_t switches = 0;
  double seconds = 0;  // simulated time
  int sessions = 0;    // number of coordinators that ran

  bool good() const { return violations.empty(); }
};

// Creates `folder` and simulates the run in this folder. Memory of killed simulated processes is
// not freed before this program ends. Must not be called in a fiber.
Outcome Simulate(const Blueprint& blueprint, uint64_t seed, const std::vector<Fault>& faults,
                 const std::filesystem::path& folder);

}  // namespace shoal::simulation
