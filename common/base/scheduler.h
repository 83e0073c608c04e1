// SPDX-License-Identifier: Apache-2.0
// The seam for simulated time and threads. Every clock, lock, wait, sleep and thread of a role goes
// through clock.h, mutex.h, sleep.h and thread_group.h; these ask Current() first. In a product
// process there is none, and they use the operating system.
//
// A scheduler runs one thread at a time on a single thread of the operating system and switches
// only in the calls below: what a simulated thread does between two of them is atomic.
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

  // Lets other threads run while `*held`, then sets it.
  virtual void Lock(bool* held) = 0;
  virtual void Unlock(bool* held) = 0;
  // Waits for a Notify of `condition` while `*held` is given up. False when the deadline came
  // first.
  virtual bool Wait(const void* condition, bool* held, SteadyTime deadline) = 0;
  virtual void Notify(const void* condition, bool all) = 0;

  // Starts a thread in the group of the calling one; the result names it in Join.
  virtual uint64_t Start(std::function<void()> body) = 0;
  virtual bool Ended(uint64_t thread) = 0;
  virtual void Join(uint64_t thread) = 0;

  // The calling thread's process owns the descriptor, and does no more (common/base/descriptor.h):
  // a simulated kill closes those that it owns.
  virtual void OnOpened(int descriptor) = 0;
  virtual void OnClosed(int descriptor) = 0;

  // The calling thread's; nullptr outside of simulations.
  static Scheduler* Current() { return current_; }
  static void SetCurrent(Scheduler* scheduler) { current_ = scheduler; }

 private:
  static inline thread_local constinit Scheduler* current_ = nullptr;
};

}  // namespace shoal
