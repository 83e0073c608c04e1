// SPDX-License-Identifier: Apache-2.0
// Threads that do one thing side by side, each its part of it, and meet on the way.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

namespace shoal::nn {

// Barrier: each of `parties` threads waits for the last of them. Afterwards each reads everything
// that the others wrote before.
//
// A waiting thread spins for 200 us, about the time between the ends of equal parts that run at
// once; then it sleeps and leaves its core to others: on a busy machine the thread that it waits
// for may need this very core. A patient barrier assumes free cores and spins for up to 2 ms,
// because a thread that sleeps takes tens of microseconds to come back, and all others wait for it.
class Barrier {
 public:
  explicit Barrier(int parties, bool patient = false) : parties_(parties), patient_(patient) {}

  void ArriveAndWait();
  // For those who arrive from now on.
  void SetPatient(bool patient) { patient_.store(patient, std::memory_order_relaxed); }

 private:
  // Lines of their own: those who wait read `round_` while others arrive.
  alignas(64) std::atomic<int> arrived_{0};
  alignas(64) std::atomic<uint32_t> round_{0};
  const int parties_;
  std::atomic<bool> patient_;
};

// N ranks: the caller of Run is the first, threads of the team the others. Between runs these
// sleep.
class Team {
 public:
  explicit Team(int ranks);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  // body(rank) for every rank at once; returns when all are done. The body must not throw. From one
  // thread at a time, the same in every run where the body builds or runs networks.
  void Run(const std::function<void(int rank)>& body);

  // Whether ranks lately lost their cores to other threads while they worked: more often than every
  // second run, averaged over about ten runs.
  bool crowded() const { return losses_ > 0.5; }

 private:
  struct alignas(64) Losses {
    int64_t count = 0;  // of the latest run
  };

  void Serve(int rank);
  void Work(const std::function<void(int)>& body, int rank);

  Barrier start_, end_;
  std::vector<Losses> losses_of_rank_;
  double losses_ = 0;                               // of a run, averaged
  const std::function<void(int)>* body_ = nullptr;  // null: the end
  std::vector<std::thread> threads_;                // last: they use the others
};

}  // namespace shoal::nn
