// SPDX-License-Identifier: Apache-2.0
// Simulated runs in child processes, several at the same time. The end of a child frees the memory
// of its killed simulated processes, and a crash fails only one run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tests/simulation/simulated_run.h"

namespace shoal::simulation {

struct ChildRun {
  uint64_t seed = 0;
  bool good = false;
  double simulated_seconds = 0;  // 0 after a crash
  std::string
      text;  // broken promises and story of a failed run; story of a good run if `with_story`
  std::string summary;  // one line
};

// Runs the seeds that `next` returns, until `next` returns 0; `jobs` runs at the same time. Calls
// `done` with each result on the calling thread. `faults` returns the faults of a seed.
void RunInChildren(const std::vector<Blueprint>& blueprints, int jobs, bool with_story,
                   const std::function<uint64_t()>& next,
                   const std::function<std::vector<Fault>(uint64_t seed)>& faults,
                   const std::function<void(const ChildRun&)>& done);

// Runs one seed.
ChildRun RunInChild(const std::vector<Blueprint>& blueprints, uint64_t seed,
                    const std::vector<Fault>& faults);

// Finds a shorter list of faults with which the run still fails: removes faults one at a time as
// long as the run fails. Returns indices into `faults`.
std::vector<size_t> ShortenedSchedule(const std::vector<Blueprint>& blueprints, uint64_t seed,
                                      const std::vector<Fault>& faults);

}  // namespace shoal::simulation
