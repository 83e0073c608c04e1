// SPDX-License-Identifier: Apache-2.0
#include "replay_server/service/gather_threads.h"

#include <algorithm>
#include <chrono>

#include "common/base/check.h"
#include "common/base/clock.h"

namespace shoal::replay {
namespace {

// Shares of the service's time; the service also stores records. The gap between the two shares
// keeps the number of threads stable while the rate of batches is constant.
constexpr double kMuch = 0.5, kEnough = 0.4;

constexpr std::chrono::hours kLong{1};  // a wait that a notification ends

}  // namespace

int GatherThreadsFor(double share, int threads, int most) {
  if (share > kMuch) return std::clamp(threads + 1, 1, most);
  const double with_fewer = threads > 1 ? share * threads / (threads - 1) : 1;
  if (with_fewer < kEnough) return std::clamp(threads - 1, 1, most);
  return std::clamp(threads, 1, most);
}

void GatherThreads::Resize(int threads) {
  CHECK(threads >= 1) << threads << " threads";
  if (threads == this->threads()) return;
  {
    const MutexLock lock(mutex_);
    leaving_ = true;
    changed_.NotifyAll();
  }
  for (Thread& helper : helpers_) helper.join();
  helpers_.clear();
  {
    const MutexLock lock(mutex_);
    leaving_ = false;
  }
  for (int i = 1; i < threads; ++i) helpers_.emplace_back([this] { Serve(); });
}

void GatherThreads::Run(int parts, const std::function<void(int part)>& part) {
  if (helpers_.empty()) {
    for (int i = 0; i < parts; ++i) part(i);
    return;
  }
  {
    const MutexLock lock(mutex_);
    parts_ = parts;
    taken_.store(0, std::memory_order_relaxed);
    job_ = &part;
    ++jobs_;
    changed_.NotifyAll();
  }
  TakeParts();
  const MutexLock lock(mutex_);
  job_ = nullptr;  // a helper that wakes up late finds no job
  while (busy_ > 0) changed_.WaitUntil(mutex_, Now() + kLong);
}

void GatherThreads::TakeParts() {
  const std::function<void(int)>* job = nullptr;
  {
    const MutexLock lock(mutex_);
    job = job_;
  }
  for (;;) {
    const int part = taken_.fetch_add(1, std::memory_order_relaxed);
    if (part >= parts_) return;
    (*job)(part);
  }
}

void GatherThreads::Serve() {
  uint64_t seen = 0;
  for (;;) {
    {
      const MutexLock lock(mutex_);
      while (!leaving_ && (job_ == nullptr || jobs_ == seen)) {
        changed_.WaitUntil(mutex_, Now() + kLong);
      }
      if (leaving_) return;
      seen = jobs_;
      ++busy_;
    }
    TakeParts();
    const MutexLock lock(mutex_);
    if (--busy_ == 0 && job_ == nullptr) changed_.NotifyAll();
  }
}

}  // namespace shoal::replay
