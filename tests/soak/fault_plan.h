// SPDX-License-Identifier: Apache-2.0
// The faults of a long test with faults (fault_soak.h): process, kind and time, drawn from a seed.
#pragma once

#include <chrono>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/base/random.h"

namespace shoal::soak {

enum class FaultKind { kKill, kStop };

struct Fault {
  std::string process;  // "actor-1", "coordinator"
  FaultKind kind = FaultKind::kKill;
  std::chrono::milliseconds delay{};  // after recovery from the previous fault
  std::string killed_meanwhile;  // another process, killed while `process` is stopped; may be empty
};

// Draws faults. A process is not killed more often than the restart limit of a run allows. After
// the coordinator's death, the caller must resume the run.
class FaultPlan {
 public:
  // `processes` does not contain the coordinator. `kills_alone`: no process is stopped.
  FaultPlan(uint64_t seed, std::vector<std::string> processes, bool kills_alone = false);

  Fault Next(SteadyTime now);

 private:
  std::string Victim(SteadyTime now);  // draws the process to kill; never the coordinator

  const std::vector<std::string> processes_;
  const bool kills_alone_;
  Random random_;
  std::map<std::string, std::deque<SteadyTime>> kills_;
};

}  // namespace shoal::soak
