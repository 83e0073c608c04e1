// SPDX-License-Identifier: Apache-2.0
// A mutex, a scoped lock and a condition variable that clang's -Wthread-safety understands: what a
// mutex guards is written at the member, and the clang preset refuses to build a use without the
// lock. Thin over the standard ones, whose Debian build carries no annotations.
//
// The attributes: https://clang.llvm.org/docs/ThreadSafetyAnalysis.html
#pragma once

#include <condition_variable>
#include <mutex>

#include "common/base/clock.h"
#include "common/base/scheduler.h"

#ifdef __clang__
#define SHOAL_THREAD_ATTRIBUTE(x) __attribute__((x))
#else
#define SHOAL_THREAD_ATTRIBUTE(x)
#endif

// A member that may be touched only while `mutex` is held.
#define SHOAL_GUARDED_BY(mutex) SHOAL_THREAD_ATTRIBUTE(guarded_by(mutex))
// A function to be called with, or without, these mutexes held.
#define SHOAL_REQUIRES(...) SHOAL_THREAD_ATTRIBUTE(requires_capability(__VA_ARGS__))
#define SHOAL_EXCLUDES(...) SHOAL_THREAD_ATTRIBUTE(locks_excluded(__VA_ARGS__))

namespace shoal {

class SHOAL_THREAD_ATTRIBUTE(capability("mutex")) Mutex {
 public:
  Mutex() = default;
  Mutex(const Mutex&) = delete;
  Mutex& operator=(const Mutex&) = delete;

  void Lock() SHOAL_THREAD_ATTRIBUTE(acquire_capability()) {
    if (Scheduler* scheduler = Scheduler::Current()) return scheduler->Lock(&held_);
    mutex_.lock();
  }
  void Unlock() SHOAL_THREAD_ATTRIBUTE(release_capability()) {
    if (Scheduler* scheduler = Scheduler::Current()) return scheduler->Unlock(&held_);
    mutex_.unlock();
  }

 private:
  friend class ConditionVariable;
  std::mutex mutex_;
  bool held_ = false;  // in a simulation
};

// Holds the mutex for a scope.
class SHOAL_THREAD_ATTRIBUTE(scoped_lockable) MutexLock {
 public:
  explicit MutexLock(Mutex& mutex) SHOAL_THREAD_ATTRIBUTE(acquire_capability(mutex))
      : mutex_(mutex) {
    mutex_.Lock();
  }
  ~MutexLock() SHOAL_THREAD_ATTRIBUTE(release_capability()) { mutex_.Unlock(); }
  MutexLock(const MutexLock&) = delete;
  MutexLock& operator=(const MutexLock&) = delete;

 private:
  Mutex& mutex_;
};

// To be waited on in a loop that looks at the condition: a wait may end for no reason. (A predicate
// would be a lambda, and the analysis does not carry locks into lambdas.)
class ConditionVariable {
 public:
  // Gives up the mutex while it waits. False when the deadline has passed.
  bool WaitUntil(Mutex& mutex, SteadyTime deadline) SHOAL_REQUIRES(mutex) {
    if (Scheduler* scheduler = Scheduler::Current()) {
      return scheduler->Wait(this, &mutex.held_, deadline);
    }
    std::unique_lock lock(mutex.mutex_, std::adopt_lock);
    const bool in_time = arrived_.wait_until(lock, deadline) == std::cv_status::no_timeout;
    lock.release();  // the caller goes on holding it
    return in_time;
  }

  void NotifyOne() {
    if (Scheduler* scheduler = Scheduler::Current()) return scheduler->Notify(this, /*all=*/false);
    arrived_.notify_one();
  }
  void NotifyAll() {
    if (Scheduler* scheduler = Scheduler::Current()) return scheduler->Notify(this, /*all=*/true);
    arrived_.notify_all();
  }

 private:
  std::condition_variable arrived_;
};

}  // namespace shoal
