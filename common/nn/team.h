// SPDX-License-Identifier: Apache-2.0
// A team of threads that work on parts of one task, and a barrier at which they wait for each
// other.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

namespace shoal::nn {

// Barrier: each of `parties` threads waits until the last one arrives. Afterwards each thread sees
// everything that the others wrote before.
//
// A waiting thread spins for 200 us. The durations of equal parts of a task differ by about this
// time. Then the thread sleeps and frees its core, because on a busy machine the awaited thread may
// need this core. A patient barrier assumes free cores and spins for up to 2 ms, because a sleeping
// thread needs tens of microseconds to wake up, and all other threads wait for it.
class Barrier {
 public:
  explicit Barrier(int parties, bool patient = false) : parties_(parties), patient_(patient) {}

  void ArriveAndWait();
  // Applies to threads that arrive from now on.
  void SetPatient(bool patient) { patient_.store(patient, std::memory_order_relaxed); }

 private:
  // The two counters are on separate cache lines, because waiting threads read `round_` while other
  // threads arrive.
  alignas(64) std::atomic<int> arrived_{0};
  alignas(64) std::atomic<uint32_t> round_{0};
  const int parties_;
  std::atomic<bool> patient_;
};

// Runs a function on N ranks. The thread that calls Run works as the first rank. The team's threads
// work as the other ranks and sleep between runs.
class Team {
 public:
  explicit Team(int ranks);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  // Runs body(rank) for all ranks in parallel and returns when all ranks are done. The body must
  // not throw. Only one thread at a time may call Run. If the body builds or runs networks, always
  // the same thread must call Run.
  void Run(const std::function<void(int rank)>& body);

  // Whether other threads recently took cores from working ranks: more than 0.5 times per run,
  // averaged over about ten runs.
  bool crowded() const { return losses_ > 0.5; }

 private:
  struct alignas(64) Losses {
    int64_t count = 0;  // losses in the latest run
  };

  void Serve(int rank);
  void Work(const std::function<void(int)>& body, int rank);

  Barrier start_, end_;
  std::vector<Losses> losses_of_rank_;
  double losses_ = 0;                               // per run, averaged
  const std::function<void(int)>* body_ = nullptr;  // null: the threads end
  std::vector<std::thread> threads_;                // last, because they use the other members
};

}  // namespace shoal::nn
