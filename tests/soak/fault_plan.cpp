// SPDX-License-Identifier: Apache-2.0
#include "tests/soak/fault_plan.h"

#include <utility>

#include "launch/processes/restart_policy.h"

namespace shoal::soak {
namespace {

using std::chrono::milliseconds;

constexpr uint64_t kLongestDelayMs = 3000;
constexpr double kKilledMeanwhile = 0.4;  // of the stops
// A kill may be noticed up to this much later than it was planned.
constexpr std::chrono::seconds kSlack{30};

}  // namespace

FaultPlan::FaultPlan(uint64_t seed, std::vector<std::string> processes, bool kills_alone)
    : processes_(std::move(processes)), kills_alone_(kills_alone), random_(seed) {}

std::string FaultPlan::Victim(SteadyTime now) {
  const launch::RestartLimits limits;
  while (true) {
    const std::string& name = processes_[random_.Below(processes_.size())];
    std::deque<SteadyTime>& kills = kills_[name];
    while (!kills.empty() && now - kills.front() > limits.window + kSlack) kills.pop_front();
    if (static_cast<int>(kills.size()) >= limits.restarts) continue;
    kills.push_back(now);
    return name;
  }
}

Fault FaultPlan::Next(SteadyTime now) {
  Fault fault;
  fault.delay = milliseconds(random_.Below(kLongestDelayMs));
  const bool kills = random_.Below(2) == 0 || kills_alone_;
  fault.kind = kills ? FaultKind::kKill : FaultKind::kStop;
  if (random_.Below(processes_.size() + 1) == 0) {
    fault.process = "coordinator";
    return fault;
  }
  if (fault.kind == FaultKind::kKill) {
    fault.process = Victim(now);
    return fault;
  }
  fault.process = processes_[random_.Below(processes_.size())];
  if (random_.Uniform() < kKilledMeanwhile) {
    const std::string other = Victim(now);
    if (other != fault.process) fault.killed_meanwhile = other;
  }
  return fault;
}

}  // namespace shoal::soak
