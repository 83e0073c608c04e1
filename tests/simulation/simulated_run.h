// SPDX-License-Identifier: Apache-2.0
// One run of the product's own coordinator, replay, learner, evaluation actor and actors on
// simulated time, with faults, and what was wrong with it afterwards.
//
// Simulated: clock, threads, link (in memory), processes, failures of the disk, environments, the
// update, the person who resumes. Real: every file, in a folder of its own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/simulation/blueprint.h"
#include "tests/simulation/fault.h"

namespace shoal::simulation {

struct Outcome {
  std::vector<std::string> violations;  // one line each; empty: all is as promised
  std::vector<std::string> story;       // what happened, in plain words
  uint64_t trace = 0;                   // equal for equal runs
  uint64_t switches = 0;
  double seconds = 0;  // simulated
  int sessions = 0;    // of coordinators

  bool good() const { return violations.empty(); }
};

// Runs in `folder`, which it makes and leaves. Memory of killed processes is kept until this
// program ends. Not to be called in a fiber.
Outcome Simulate(const Blueprint& blueprint, uint64_t seed, const std::vector<Fault>& faults,
                 const std::filesystem::path& folder);

}  // namespace shoal::simulation
