// SPDX-License-Identifier: Apache-2.0
// One run of the product's own coordinator, replay, learner, evaluation actor and actors on
// simulated time, with faults drawn from a seed, and what was wrong with it afterwards.
//
// Simulated: clock, threads, link (in memory), processes, environments, the update. Real: every
// file, in a folder of its own.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/config/run_config.h"
#include "common/nn/safetensors.h"

namespace shoal::simulation {

// Configuration and weights that every simulated run begins with. Making one asks the real task and
// a real agent: once is enough.
struct Blueprint {
  RunConfig run;
  nn::TensorMap policy;
};
Blueprint MakeBlueprint();

struct Fault {
  enum class Kind { kKill, kPause };
  Kind kind = Kind::kKill;
  std::chrono::milliseconds at{0};    // simulated, after the start
  std::string process;                // "actor-1"
  std::chrono::milliseconds span{0};  // of a pause

  std::string Text() const;
};

// Faults of a seed, by time.
std::vector<Fault> DrawFaults(uint64_t seed, const Config& config);

struct Outcome {
  std::vector<std::string> violations;  // one line each; empty: all is as promised
  uint64_t trace = 0;                   // equal for equal runs
  uint64_t switches = 0;
  double seconds = 0;  // simulated
  std::string exit;    // "budget", ...
  std::string log;     // what the coordinator said

  bool good() const { return violations.empty(); }
};

// Runs in `folder`, which it makes and leaves. Memory of killed processes is kept until this
// program ends. Not to be called in a fiber.
Outcome Simulate(const Blueprint& blueprint, uint64_t seed, const std::vector<Fault>& faults,
                 const std::filesystem::path& folder);

}  // namespace shoal::simulation
