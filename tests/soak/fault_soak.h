// SPDX-License-Identifier: Apache-2.0
// Faults at random times during one training run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace shoal::soak {

struct SoakOptions {
  std::filesystem::path folder;    // an empty one
  std::filesystem::path programs;  // folder of the program shoal
  int actors = 2;
  uint64_t seed = 1;
  std::string preset = "fetch-reach-state";
  std::string environment{};        // as `shoal train --env` takes it; empty = the preset's task
  std::vector<std::string> keys{};  // further KEY=VALUE
  // Seconds until all processes continue after a fault. A busy machine needs more.
  int recovery = 60;
  bool kills_alone = false;  // no SIGSTOPs
};

// Causes `faults` faults, prints a line for each, stops the run and checks its files. Throws Broken
// (run_under_test.h) at the first broken rule. Returns counts, recovery times and the account.
nlohmann::ordered_json SoakFaults(const SoakOptions& options, int faults);

}  // namespace shoal::soak
