// SPDX-License-Identifier: Apache-2.0
// Runs the product's own coordinator, replay, learner, evaluation actor and actors on simulated
// time with faults, and reports broken promises.
//
// Simulated: clock, threads, link (in memory), processes, failures of the disk, environments, the
// update, the user who resumes. Real: every file, in a separate folder.
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
  double seconds = 0;  // simulated
  int sessions = 0;    // of coordinators

  bool good() const { return violations.empty(); }
};

// Creates `folder` and runs in it. Memory of killed processes is not freed before this program
// ends. Must not be called in a fiber.
Outcome Simulate(const Blueprint& blueprint, uint64_t seed, const std::vector<Fault>& faults,
                 const std::filesystem::path& folder);

}  // namespace shoal::simulation
