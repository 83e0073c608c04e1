// SPDX-License-Identifier: Apache-2.0
// Interface for simulated time and threads. The code of a role uses clocks, locks, waits, sleeps
// and threads only through clock.h, mutex.h, sleep.h and thread_group.h, which check Current()
// first. Without a scheduler, as in the product, these headers use the operating system.
//
// A scheduler runs all simulated threads on a single thread of the operating system. It switches
// threads only in the calls below, so a simulated thread is atomic between two calls.
#pragma once

#include <cstdint>
#include <functional>

#include "common/base/steady_time.h"

namespace shoal {

class Scheduler {
 public:
  virtual ~Scheduler() = default;

  virtual SteadyTime Now() = 0;
  virtual int64_t WallTimeNs() = 0;  // since 1970; may jump
  virtual void SleepUntil(SteadyTime time) = 0;

  // Lets other threads run while `*held` is true, then sets `*held`.
  virtual void Lock(bool* held) = 0;
  virtual void Unlock(bool* held) = 0;
  // Waits for a Notify of `condition`. During the wait, `*held` is false. Returns false if the
  // deadline passed before the Notify.
  virtual bool Wait(const void* condition, bool* held, SteadyTime deadline) = 0;
  virtual void Notify(const void* condition, bool all) = 0;

  // Starts a thread in the group of the calling thread. Returns the number of the new thread, for
  // Ended and Join.
  virtual uint64_t Start(std::function<void()> body) = 0;
  virtual bool Ended(uint64_t thread) = 0;
  virtual void Join(uint64_t thread) = 0;

  // Called after the calling thread's process has opened, or before it closes, the descriptor
  // (common/base/descriptor.h). A simulated kill closes the descriptors of the killed process.
  virtual void OnOpened(int descriptor) = 0;
  virtual void OnClosed(int descriptor) = 0;

  // The calling thread's scheduler; nullptr outside simulations.
  static Scheduler* Current() { return current_; }
  static void SetCurrent(Scheduler* scheduler) { current_ = scheduler; }

 private:
  static inline thread_local constinit Scheduler* current_ = nullptr;
};

}  // namespace shoal
