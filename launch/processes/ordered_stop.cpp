// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/ordered_stop.h"

#include <fmt/core.h>

#include <csignal>

#include "common/base/sleep.h"

namespace shoal::launch {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPoll{50};
constexpr milliseconds kAtOnce{1000};      // between SIGTERM and SIGKILL after a second Ctrl-C
constexpr milliseconds kReapKilled{5000};  // after SIGKILL; exceeded only in uninterruptible I/O

// Waits until no process of the role is left. Returns false at the deadline and, if `patient`, when
// hooks.at_once() is true.
bool WaitForExit(Supervisor& supervisor, std::string_view role, milliseconds deadline,
                 const StopHooks& hooks, bool patient) {
  const SteadyTime start = Now();
  while (true) {
    // If a process fails permanently while actors drain, the drain still ends at the deadline.
    if (const auto failure = supervisor.Poll(Now())) hooks.say(*failure);
    if (supervisor.Running(role) == 0) return true;
    if (Now() - start > deadline || (patient && hooks.at_once())) return false;
    hooks.tick();
    SleepFor(kPoll);
  }
}

void EndRole(Supervisor& supervisor, std::string_view role, milliseconds deadline,
             const StopDeadlines& deadlines, const StopHooks& hooks) {
  if (WaitForExit(supervisor, role, deadline, hooks, /*patient=*/true)) return;
  const bool hurried = hooks.at_once();
  if (!hurried) {
    hooks.say(fmt::format("{} process(es) did not leave within {:.1f} s: SIGTERM",
                          supervisor.Running(role), static_cast<double>(deadline.count()) / 1000));
  }
  supervisor.Signal(role, SIGTERM);
  const milliseconds terminate = hurried ? kAtOnce : deadlines.terminate;
  if (WaitForExit(supervisor, role, terminate, hooks, /*patient=*/!hurried)) return;
  supervisor.Signal(role, SIGKILL);
  WaitForExit(supervisor, role, kReapKilled, hooks, /*patient=*/false);
}

void WaitUntilSettled(Supervisor& supervisor, const StopDeadlines& deadlines,
                      const StopHooks& hooks) {
  const SteadyTime start = Now();
  SteadyTime worked = start;
  double work = hooks.work();
  while (!hooks.settled() && !hooks.at_once() && supervisor.Running("eval") > 0) {
    if (const auto failure = supervisor.Poll(Now())) return hooks.say(*failure);
    if (const double done = hooks.work(); done != work) {
      work = done;
      worked = Now();
    }
    if (Now() - worked > deadlines.settle || Now() - start > deadlines.settle_in_all) {
      return hooks.say("the last evaluation did not come in time");
    }
    hooks.tick();
    SleepFor(kPoll);
  }
}

}  // namespace

void StopInOrder(Supervisor& supervisor, const StopDeadlines& deadlines, const StopHooks& hooks) {
  supervisor.ExpectExit("actor");
  hooks.announce(RunState::kDraining);
  EndRole(supervisor, "actor", deadlines.drain, deadlines, hooks);
  WaitUntilSettled(supervisor, deadlines, hooks);
  supervisor.ExpectExit("");
  hooks.announce(RunState::kStopping);
  EndRole(supervisor, "", deadlines.finish, deadlines, hooks);
}

}  // namespace shoal::launch
