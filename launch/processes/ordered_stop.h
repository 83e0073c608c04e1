// SPDX-License-Identifier: Apache-2.0
// Stops a run's processes in order. The actors send their records until all are stored, and exit.
// Then learner, replay and evaluation actor finish their work, write their files and exit.
#pragma once

#include <chrono>
#include <functional>

#include "common/wire/messages.h"
#include "launch/processes/supervisor.h"

namespace shoal::launch {

struct StopDeadlines {
  std::chrono::milliseconds drain{30'000};     // actors, after kDraining
  std::chrono::milliseconds settle{120'000};   // for `settled`, once the actors have left
  std::chrono::milliseconds finish{60'000};    // the others, after kStopping
  std::chrono::milliseconds terminate{5'000};  // after SIGTERM, before SIGKILL
};

struct StopHooks {
  std::function<void(RunState)> announce;  // sends the state to the processes
  std::function<void()> tick;              // called every 50 ms meanwhile (heartbeat)
  std::function<bool()> at_once;           // true: skip to SIGTERM, short
  std::function<void(const std::string&)> say;
  // Once the actors have left, the other processes continue until this returns true (the last
  // evaluation has arrived).
  std::function<bool()> settled = [] { return true; };
};

// Returns when no process is left, at the latest after the sum of the deadlines.
void StopInOrder(Supervisor& supervisor, const StopDeadlines& deadlines, const StopHooks& hooks);

}  // namespace shoal::launch
