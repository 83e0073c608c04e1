// SPDX-License-Identifier: Apache-2.0
// The threads of one role, if several roles of a run share a process (shoal train --in-process). A
// group has its own stop request and its own log. A role with its own process has no group; it uses
// the stop request and the log of the process (stop.h, log.h).
#pragma once

#include <pthread.h>

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "common/base/log.h"
#include "common/base/mutex.h"
#include "common/base/scheduler.h"

namespace shoal {

class ThreadGroup {
 public:
  // Each line of the log begins with `name` (such as "actor-3") and is appended to `log_file`.
  // Throws Error if the file cannot be opened.
  ThreadGroup(const std::string& name, const std::string& log_file)
      : log_(log::OpenFile(name, log_file)) {}
  ThreadGroup(const ThreadGroup&) = delete;
  ThreadGroup& operator=(const ThreadGroup&) = delete;

  // Requests that the group stops, like a stop signal for a process. Any thread may call it.
  void RequestStop() { stop_requests_.fetch_add(1, std::memory_order_relaxed); }
  int StopRequests() const { return stop_requests_.load(std::memory_order_relaxed); }
  log::File& log() { return *log_; }
  // Processor time of the members, including members that have ended.
  double CpuSeconds() const;

  // The group of the calling thread; nullptr if it has none.
  static ThreadGroup* Current();

  // Sets Current() for a scope without making the thread a member. For a scheduler of simulated
  // threads.
  class Bound {
   public:
    explicit Bound(ThreadGroup* group);
    ~Bound();
    Bound(const Bound&) = delete;
    Bound& operator=(const Bound&) = delete;

   private:
    ThreadGroup* const former_;
  };

  // Makes the calling thread a member of a group for a scope; nullptr: of no group.
  class Member {
   public:
    explicit Member(ThreadGroup* group);
    ~Member();
    Member(const Member&) = delete;
    Member& operator=(const Member&) = delete;

   private:
    ThreadGroup* const group_;
    ThreadGroup* const former_;
  };

 private:
  void Enter();
  void Leave();

  std::atomic<int> stop_requests_{0};
  mutable Mutex mutex_;
  std::vector<pthread_t> members_ SHOAL_GUARDED_BY(mutex_);
  double ended_seconds_ SHOAL_GUARDED_BY(mutex_) = 0;  // of members that have ended
  const std::shared_ptr<log::File> log_;
};

// A std::thread that belongs to the group of the thread that creates it. Every thread of a role is
// a Thread.
class Thread {
 public:
  Thread() = default;
  template <class Body>
  explicit Thread(Body body) {
    if (Scheduler* scheduler = Scheduler::Current()) {
      simulated_ = scheduler->Start(std::move(body));
      return;
    }
    thread_ = std::thread([group = ThreadGroup::Current(), body = std::move(body)]() mutable {
      const ThreadGroup::Member member(group);
      body();
    });
  }

  bool joinable() const { return simulated_ != 0 || thread_.joinable(); }
  void join() {
    if (simulated_ == 0) return thread_.join();
    Scheduler::Current()->Join(std::exchange(simulated_, 0));
  }

 private:
  std::thread thread_;
  uint64_t simulated_ = 0;  // number of the thread in a simulation; else 0
};

}  // namespace shoal
