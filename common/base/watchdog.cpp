// SPDX-License-Identifier: Apache-2.0
#include "common/base/watchdog.h"

#include <unistd.h>

#include <utility>

#include "common/base/log.h"

namespace shoal {

Watchdog::Watchdog(std::string what, std::chrono::milliseconds limit)
    : what_(std::move(what)), limit_(limit), thread_([this] { Watch(); }) {}

Watchdog::~Watchdog() {
  {
    const MutexLock lock(mutex_);
    done_ = true;
    changed_.NotifyAll();
  }
  thread_.join();
}

void Watchdog::Watch() {
  const SteadyTime deadline = Now() + limit_;
  const MutexLock lock(mutex_);
  while (!done_ && changed_.WaitUntil(mutex_, deadline)) {
  }
  if (done_) return;
  log::Failure("{} took longer than {} ms: leaving at once", what_, limit_.count());
  _exit(1);
}

}  // namespace shoal
