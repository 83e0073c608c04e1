// SPDX-License-Identifier: Apache-2.0
// Threads that do one thing side by side, each its part of it, and meet on the way.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

namespace shoal::nn {

// Where all of `parties` threads wait for the last of them. What each wrote before, all read after.
//
// Who waits spins for 200 us, about what parts of equal work that run at once are apart; then it
// sleeps and leaves its core to who is still at work: on a busy machine that may be the very thread
// that is waited for.
class Barrier {
 public:
  explicit Barrier(int parties) : parties_(parties) {}

  void ArriveAndWait();

 private:
  const int parties_;
  std::atomic<int> arrived_{0};
  std::atomic<uint32_t> round_{0};
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

 private:
  void Serve(int rank);

  Barrier start_, end_;
  const std::function<void(int)>* body_ = nullptr;  // null: the end
  std::vector<std::thread> threads_;                // last: they use the others
};

}  // namespace shoal::nn
