// SPDX-License-Identifier: Apache-2.0
// A mutex, a scoped lock and a condition variable with annotations for clang's -Wthread-safety. An
// annotation of a member names the mutex that guards the member. A build with the clang preset
// fails if code uses the member without the lock. These classes are thin wrappers around the
// standard classes, which have no annotations in Debian.
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

// A member that may be read or written only while `mutex` is held.
#define SHOAL_GUARDED_BY(mutex) SHOAL_THREAD_ATTRIBUTE(guarded_by(mutex))
// REQUIRES: a function that must be called with these mutexes held. EXCLUDES: a function that must
// be called with none of these mutexes held.
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
  bool held_ = false;  // used in simulations only
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

// Wait in a loop that checks the condition, because a wait may end without a notification. There is
// no overload with a predicate, because the analysis does not see in a lambda that a lock is held.
class ConditionVariable {
 public:
  // Releases the mutex during the wait. Returns false if the deadline has passed.
  bool WaitUntil(Mutex& mutex, SteadyTime deadline) SHOAL_REQUIRES(mutex) {
    if (Scheduler* scheduler = Scheduler::Current()) {
      return scheduler->Wait(this, &mutex.held_, deadline);
    }
    std::unique_lock lock(mutex.mutex_, std::adopt_lock);
    const bool in_time = arrived_.wait_until(lock, deadline) == std::cv_status::no_timeout;
    lock.release();  // the caller still holds the mutex
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
