// SPDX-License-Identifier: Apache-2.0
#include "tests/soak/fault_plan.h"

#include <gtest/gtest.h>

#include <set>

#include "launch/processes/restart_policy.h"

namespace shoal::soak {
namespace {

using std::chrono::seconds;

const std::vector<std::string> kProcesses{"replay-0", "learner-0", "eval-0", "actor-0", "actor-1"};
const SteadyTime kStart = SteadyTime() + seconds(1000);

TEST(FaultPlan, StrikesEveryProcessInEveryWay) {
  FaultPlan plan(1, kProcesses);
  std::set<std::string> killed, stopped;
  for (int i = 0; i < 200; ++i) {
    const Fault fault = plan.Next(kStart + i * seconds(30));
    (fault.kind == FaultKind::kKill ? killed : stopped).insert(fault.process);
    EXPECT_NE(fault.killed_meanwhile, fault.process);
  }
  std::set<std::string> all(kProcesses.begin(), kProcesses.end());
  all.insert("coordinator");
  EXPECT_EQ(killed, all);
  EXPECT_EQ(stopped, all);
}

TEST(FaultPlan, KillsNoProcessMoreOftenThanARunBears) {
  FaultPlan plan(2, {"replay-0", "learner-0", "actor-0"});
  std::map<std::string, std::deque<SteadyTime>> kills;
  for (int i = 0; i < 300; ++i) {
    const SteadyTime now = kStart + i * seconds(7);
    const Fault fault = plan.Next(now);
    const std::string victim =
        fault.kind == FaultKind::kKill ? fault.process : fault.killed_meanwhile;
    if (victim.empty()) continue;
    std::deque<SteadyTime>& recent = kills[victim];
    while (!recent.empty() && now - recent.front() > launch::RestartLimits().window) {
      recent.pop_front();
    }
    recent.push_back(now);
    EXPECT_LE(static_cast<int>(recent.size()), launch::RestartLimits().restarts) << victim;
  }
}

TEST(FaultPlan, KillsAloneStopNothing) {
  FaultPlan plan(1, kProcesses, /*kills_alone=*/true);
  for (int i = 0; i < 100; ++i) {
    const Fault fault = plan.Next(kStart + i * seconds(30));
    EXPECT_EQ(fault.kind, FaultKind::kKill);
    EXPECT_EQ(fault.killed_meanwhile, "");
  }
}

TEST(FaultPlan, TheSameSeedGivesTheSameFaults) {
  FaultPlan one(3, kProcesses), same(3, kProcesses), other(4, kProcesses);
  int differences = 0;
  for (int i = 0; i < 20; ++i) {
    const SteadyTime now = kStart + i * seconds(20);
    const Fault a = one.Next(now), b = same.Next(now), c = other.Next(now);
    EXPECT_EQ(a.process, b.process);
    EXPECT_EQ(a.delay, b.delay);
    differences += a.process != c.process || a.delay != c.delay;
  }
  EXPECT_GT(differences, 10);
}

}  // namespace
}  // namespace shoal::soak
