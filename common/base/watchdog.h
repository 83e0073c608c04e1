// SPDX-License-Identifier: Apache-2.0
// Ends the process when something that cannot be interrupted takes too long: a hang becomes a line
// in the log and an exit that the supervisor sees.
#pragma once

#include <chrono>
#include <string>
#include <thread>

#include "common/base/mutex.h"

namespace shoal {

// While it lives longer than `limit`: logs "WHAT took longer than N ms: leaving at once" and calls
// _exit(1), so no destructor runs and nothing buffered is written. A thread of its own.
class Watchdog {
 public:
  Watchdog(std::string what, std::chrono::milliseconds limit);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

 private:
  void Watch();

  const std::string what_;
  const std::chrono::milliseconds limit_;
  Mutex mutex_;
  ConditionVariable changed_;
  bool done_ SHOAL_GUARDED_BY(mutex_) = false;
  std::thread thread_;  // last: starts when everything else is there
};

}  // namespace shoal
