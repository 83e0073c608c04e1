// SPDX-License-Identifier: Apache-2.0
// Long test: faults at random times during one training run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace shoal::soak {

struct SoakOptions {
  std::filesystem::path folder;    // an empty folder
  std::filesystem::path programs;  // folder of the program shoal
  int actors = 2;
  uint64_t seed = 1;
  std::string preset = "fetch-reach-state";
  std::string environment{};        // value for `shoal train --env`; empty = the preset's task
  std::vector<std::string> keys{};  // further KEY=VALUE
  // Seconds within which all processes must continue after a fault. A busy machine needs more time.
  int recovery = 60;
  bool kills_alone = false;  // true: only SIGKILL, no SIGSTOP
};

// Causes `faults` faults, prints a line for each fault, stops the run and checks the run's files.
// Throws Broken (run_under_test.h) at the first broken rule. Returns counts, recovery times and the
// account of records.
nlohmann::ordered_json SoakFaults(const SoakOptions& options, int faults);

}  // namespace shoal::soak
