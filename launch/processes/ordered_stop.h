// SPDX-License-Identifier: Apache-2.0
// Stops a run's processes in order. The actors exit after all their records are stored. Then
// learner, replay and evaluation actor finish their work, write their files and exit.
#pragma once

#include <chrono>
#include <functional>

#include "common/wire/messages.h"
#include "launch/processes/supervisor.h"

namespace shoal::launch {

struct StopDeadlines {
  std::chrono::milliseconds drain{30'000};             // for the actors, after kDraining
  std::chrono::milliseconds settle{120'000};           // for `settled`, since `work` last changed
  std::chrono::milliseconds settle_in_all{1'800'000};  // for `settled`, after the actors' exit
  std::chrono::milliseconds finish{60'000};            // for the other processes, after kStopping
  std::chrono::milliseconds terminate{5'000};          // after SIGTERM, before SIGKILL
};

struct StopHooks {
  std::function<void(RunState)> announce;  // sends the state to the processes
  std::function<void()> tick;              // called every 50 ms during the stop (heartbeat)
  std::function<bool()> at_once;           // true: send SIGTERM now and wait only briefly
  std::function<void(const std::string&)> say;
  // After the actors have exited, the other processes continue until `settled` returns true (the
  // last evaluation has arrived).
  std::function<bool()> settled = [] { return true; };
  // Work done so far (updates, evaluation). While it changes, the wait for `settled` continues: an
  // evaluation of long episodes may take many minutes.
  std::function<double()> work = [] { return 0.0; };
};

// Returns when no process runs any more, at the latest after the sum of the deadlines.
void StopInOrder(Supervisor& supervisor, const StopDeadlines& deadlines, const StopHooks& hooks);

}  // namespace shoal::launch
