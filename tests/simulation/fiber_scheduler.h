// SPDX-License-Identifier: Apache-2.0
// Simulated time and threads (common/base/scheduler.h): fibers on one thread of the operating
// system. A fiber runs until it waits. The next fiber is drawn from a seed, so a simulation can be
// repeated, and another seed gives another order.
//
// Time does not pass while a fiber computes. Only each read of the clock takes kPerLook, so that a
// loop that polls the clock ends. If no fiber can run, time advances to the earliest wake-up.
//
// Fibers belong to processes, identified by their thread group. The fibers of a killed process
// never run again, and their destructors do not run, as after SIGKILL. The memory of these fibers
// is not freed before this program ends, so simulate in a child process.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/base/random.h"
#include "common/base/scheduler.h"
#include "common/base/thread_group.h"

namespace shoal::simulation {

class FiberScheduler final : public Scheduler {
 public:
  static constexpr std::chrono::nanoseconds kPerLook{200};

  // Time starts at zero of the steady clock, and at `wall_time_ns` of the wall clock.
  FiberScheduler(uint64_t seed, int64_t wall_time_ns);
  ~FiberScheduler() override;
  FiberScheduler(const FiberScheduler&) = delete;
  FiberScheduler& operator=(const FiberScheduler&) = delete;

  // Starts the first fiber of a process. Fibers must not call StartIn.
  uint64_t StartIn(ThreadGroup* group, std::function<void()> body);
  // Runs fibers until the time `until`, or until no fiber is left.
  void RunUntil(SteadyTime until);

  // Pauses the group: none of its fibers runs before `time`. Wake-ups are kept.
  void Pause(ThreadGroup* group, SteadyTime time);
  // Stalls one fiber of the group, selected by `which`: the fiber does not run before `time`.
  void Stall(ThreadGroup* group, uint64_t which, SteadyTime time);
  // Slows the group down: until `time`, each turn of its fibers takes `turn`.
  void SlowDown(ThreadGroup* group, SteadyTime::duration turn, SteadyTime time);
  // Draws a number below `count` from the seed.
  size_t Draw(size_t count) { return random_.Below(count); }
  // Removes the fibers of the group and closes its descriptors.
  void Kill(ThreadGroup* group);
  // Number of fibers of the group that have not ended.
  int Alive(const ThreadGroup* group) const;
  // Moves the wall clock.
  void MoveWallClock(std::chrono::nanoseconds by) { wall_offset_ns_ += by.count(); }

  // The time, for callers outside of fibers.
  SteadyTime NowOutside() const { return now_; }
  // A hash of the choices and their times, for comparisons of runs.
  uint64_t TraceHash() const { return trace_; }
  uint64_t switches() const { return switches_; }

  SteadyTime Now() override;
  int64_t WallTimeNs() override;
  void SleepUntil(SteadyTime time) override;
  void Lock(bool* held) override;
  void Unlock(bool* held) override;
  bool Wait(const void* condition, bool* held, SteadyTime deadline) override;
  void Notify(const void* condition, bool all) override;
  uint64_t Start(std::function<void()> body) override;
  bool Ended(uint64_t thread) override;
  void Join(uint64_t thread) override;
  void OnOpened(int descriptor) override;
  void OnClosed(int descriptor) override;

 private:
  struct Fiber;

  // Suspends the fiber until it is runnable again, at `wake` at the latest.
  void Block(SteadyTime wake);
  // Waits for a Notify of `condition`. Returns false at the deadline.
  bool WaitFor(const void* condition, SteadyTime deadline);
  // Draws a runnable fiber; nullptr if there is none.
  Fiber* Choose();
  SteadyTime EarliestWake() const;
  void Resume(Fiber* fiber);
  static void Enter();
  Fiber* Find(uint64_t id);

  Random random_;
  SteadyTime now_{};
  const int64_t wall_start_ns_;
  int64_t wall_offset_ns_ = 0;
  std::vector<std::unique_ptr<Fiber>> fibers_;
  std::vector<std::unique_ptr<Fiber>> killed_;  // never resumed, never destroyed
  std::vector<Fiber*> runnable_;                // memory for Choose
  Fiber* running_ = nullptr;
  std::map<int, const ThreadGroup*> files_;  // open descriptors
  struct Slow {
    SteadyTime::duration turn;
    SteadyTime until;
  };
  std::map<const ThreadGroup*, Slow> slow_;
  uint64_t next_id_ = 1, trace_ = 0, switches_ = 0;
  struct Main;
  std::unique_ptr<Main> main_;
};

}  // namespace shoal::simulation
