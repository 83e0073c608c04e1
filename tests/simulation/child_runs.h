// SPDX-License-Identifier: Apache-2.0
// Simulated runs in child processes, several at once. The end of a child frees the memory of its
// killed processes, and a crash fails only one run.
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
      text;  // what was wrong, and the story; of a good run the story where it was asked for
  std::string summary;  // one line
};

// Runs the seeds that `next` returns, until it returns 0; `jobs` at once. Calls `done` with each
// result on the calling thread. `faults` returns the faults of a seed.
void RunInChildren(const std::vector<Blueprint>& blueprints, int jobs, bool with_story,
                   const std::function<uint64_t()>& next,
                   const std::function<std::vector<Fault>(uint64_t seed)>& faults,
                   const std::function<void(const ChildRun&)>& done);

// Runs one seed.
ChildRun RunInChild(const std::vector<Blueprint>& blueprints, uint64_t seed,
                    const std::vector<Fault>& faults);

// A shorter list of faults that still fails, as indices into `faults`: removes faults one at a time
// while the run still fails.
std::vector<size_t> ShortenedSchedule(const std::vector<Blueprint>& blueprints, uint64_t seed,
                                      const std::vector<Fault>& faults);

}  // namespace shoal::simulation
