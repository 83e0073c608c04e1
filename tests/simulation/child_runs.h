// SPDX-License-Identifier: Apache-2.0
// Simulated runs in child processes, several at once: each takes the memory of what it killed with
// it, and one that crashes fails alone.
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
  double simulated_seconds = 0;  // 0 of one that crashed
  std::string
      text;  // what was wrong, and the story; of a good run the story where it was asked for
  std::string summary;  // one line
};

// Runs seeds in the order in which `next` gives them, until it gives 0; `jobs` at once. `done` gets
// each result on the calling thread, as it comes. `faults` gives a seed's.
void RunInChildren(const std::vector<Blueprint>& blueprints, int jobs, bool with_story,
                   const std::function<uint64_t()>& next,
                   const std::function<std::vector<Fault>(uint64_t seed)>& faults,
                   const std::function<void(const ChildRun&)>& done);

// One of them.
ChildRun RunInChild(const std::vector<Blueprint>& blueprints, uint64_t seed,
                    const std::vector<Fault>& faults);

// The numbers of faults in `faults` without which the run does not fail, in order: they are left
// out one at a time while it still fails.
std::vector<size_t> ShortenedSchedule(const std::vector<Blueprint>& blueprints, uint64_t seed,
                                      const std::vector<Fault>& faults);

}  // namespace shoal::simulation
