// SPDX-License-Identifier: Apache-2.0
// Faults at random moments against one training run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace shoal::soak {

struct SoakOptions {
  std::filesystem::path folder;    // an empty one
  std::filesystem::path programs;  // where shoal is
  int actors = 2;
  uint64_t seed = 1;
  std::string preset = "fetch-reach-state";
  std::string environment{};        // as `shoal train --env` takes it; empty = the preset's task
  std::vector<std::string> keys{};  // further KEY=VALUE
  // Seconds for everything to go on after a fault. A machine that other work keeps busy needs more.
  int recovery = 60;
  bool kills_alone = false;  // no SIGSTOPs
};

// Strikes `faults` times, prints a line for each, stops the run and checks what it left. Throws
// Broken (run_under_test.h) at the first broken rule. The result is for people: counts, recovery
// times, the account.
nlohmann::ordered_json SoakFaults(const SoakOptions& options, int faults);

}  // namespace shoal::soak
