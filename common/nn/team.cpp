// SPDX-License-Identifier: Apache-2.0
#include "common/nn/team.h"

#include <sched.h>
#include <sys/resource.h>

#include <chrono>

#include "common/base/check.h"
#include "common/base/clock.h"

namespace shoal::nn {
namespace {

// Measured with updates of 15 ms (compact, batch 128): spins of 5, 50 and 300 us gave 1.2, 1.4 and
// 1.5 times the updates of one thread on idle cores, and no difference beside a busy one.
constexpr std::chrono::microseconds kSpin{200};
constexpr std::chrono::microseconds kPatientSpin{2'000};
constexpr int kLooksPerClock = 16;  // reading the clock costs more than looking
constexpr double kNewest = 0.1;     // weight of the latest run in the mean of losses

// How often the kernel took the core from the calling thread although the thread had work.
int64_t CoreLosses() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nivcsw;
}

}  // namespace

void Barrier::ArriveAndWait() {
  const uint32_t round = round_.load(std::memory_order_acquire);
  if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == parties_) {
    arrived_.store(0, std::memory_order_relaxed);  // published by the next round's number
    round_.store(round + 1, std::memory_order_release);
    round_.notify_all();  // no system call if no thread sleeps
    return;
  }
  const SteadyTime start = Now();
  do {
    for (int i = 0; i < kLooksPerClock; ++i) {
      if (round_.load(std::memory_order_acquire) != round) return;
      __builtin_ia32_pause();
    }
  } while (Now() < start + kSpin);
  const bool patient = patient_.load(std::memory_order_relaxed);
  while (patient && Now() < start + kPatientSpin) {
    if (round_.load(std::memory_order_acquire) != round) return;
    sched_yield();  // to another thread that waits for this core, if there is one
  }
  while (round_.load(std::memory_order_acquire) == round) round_.wait(round);
}

Team::Team(int ranks) : start_(ranks), end_(ranks), losses_of_rank_(size_t(ranks)) {
  CHECK(ranks > 0) << ranks << " ranks";
  for (int rank = 1; rank < ranks; ++rank) threads_.emplace_back([this, rank] { Serve(rank); });
}

Team::~Team() {
  // A round without a body ends the threads.
  body_ = nullptr;
  start_.ArriveAndWait();
  for (std::thread& thread : threads_) thread.join();
}

void Team::Run(const std::function<void(int rank)>& body) {
  if (threads_.empty()) return body(0);
  body_ = &body;
  end_.SetPatient(!crowded());
  start_.ArriveAndWait();
  Work(body, 0);
  end_.ArriveAndWait();
  double losses = 0;
  for (const Losses& of_rank : losses_of_rank_) losses += double(of_rank.count);
  losses_ += kNewest * (losses - losses_);
}

void Team::Work(const std::function<void(int)>& body, int rank) {
  const int64_t before = CoreLosses();
  body(rank);
  losses_of_rank_[size_t(rank)].count = CoreLosses() - before;
}

void Team::Serve(int rank) {
  for (;;) {
    start_.ArriveAndWait();
    if (body_ == nullptr) return;
    Work(*body_, rank);
    end_.ArriveAndWait();
  }
}

}  // namespace shoal::nn
