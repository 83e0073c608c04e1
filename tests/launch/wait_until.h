// SPDX-License-Identifier: Apache-2.0
// Waits for an effect of another process.
#pragma once

#include <chrono>
#include <thread>

#include "common/base/clock.h"

namespace shoal {

// Polls until `condition` returns true. Returns false after ten seconds.
template <class Condition>
bool WaitUntil(Condition condition) {
  const SteadyTime start = Now();
  while (!condition()) {
    if (SecondsSince(start) > 10) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace shoal
