// SPDX-License-Identifier: Apache-2.0
// Ends the process if an operation that cannot be interrupted takes too long. The process then
// writes a line to the log and exits instead of hanging, and the supervisor detects the exit.
#pragma once

#include <chrono>
#include <string>
#include <thread>

#include "common/base/mutex.h"

namespace shoal {

// If the object lives longer than `limit`, its thread logs "WHAT took longer than N ms: leaving at
// once" and calls _exit(1). No destructor runs, and buffered output is lost.
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
  std::thread thread_;  // last member: starts when all others are initialised
};

}  // namespace shoal
