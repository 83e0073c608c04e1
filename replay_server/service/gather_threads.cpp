// SPDX-License-Identifier: Apache-2.0
#include "replay_server/service/gather_threads.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "common/base/check.h"
#include "common/base/clock.h"

namespace shoal::replay {
namespace {

// The gap between the two shares keeps the number of threads stable while the rate of batches is
// constant.
constexpr double kMuch = 0.5, kEnough = 0.4;

constexpr std::chrono::hours kLong{1};  // a wait that a notification ends

}  // namespace

int GatherThreadsFor(double share, int threads, int most) {
  if (share > kMuch) {
    const auto enough = static_cast<int>(std::ceil(share * threads / kMuch));
    return std::clamp(std::max(enough, threads + 1), 1, most);
  }
  const double with_fewer = threads > 1 ? share * threads / (threads - 1) : 1;
  if (with_fewer < kEnough) return std::clamp(threads - 1, 1, most);
  return std::clamp(threads, 1, most);
}

GatherThreads::GatherThreads(int threads, std::function<void()> on_done)
    : on_done_(std::move(on_done)) {
  Resize(threads);
}

void GatherThreads::Resize(int threads) {
  CHECK(threads >= 1) << threads << " threads";
  if (threads == this->threads()) return;
  {
    const MutexLock lock(mutex_);
    leaving_ = true;
    work_.NotifyAll();
  }
  for (Thread& helper : helpers_) helper.join();
  helpers_.clear();
  {
    const MutexLock lock(mutex_);
    leaving_ = false;
  }
  for (int i = 1; i < threads; ++i) helpers_.emplace_back([this] { Serve(); });
}

uint64_t GatherThreads::Start(int parts, std::function<void(int part)> part) {
  const MutexLock lock(mutex_);
  const uint64_t number = ++started_;
  if (parts <= 0) return number;
  jobs_.push_back({number, parts, 0, 0, std::move(part)});
  work_.NotifyAll();
  return number;
}

bool GatherThreads::Done(uint64_t job) const {
  const MutexLock lock(mutex_);
  return std::ranges::find(jobs_, job, &Job::number) == jobs_.end();
}

bool GatherThreads::HasWork() const {
  const MutexLock lock(mutex_);
  return std::ranges::any_of(jobs_, [](const Job& job) { return job.taken < job.parts; });
}

bool GatherThreads::Help() {
  const MutexLock lock(mutex_);
  Job* job = Waiting();
  if (job == nullptr) return false;
  if (!helpers_.empty()) {
    RunPart(job);
    return true;
  }
  while (!RunPart(job)) {
  }
  return true;
}

void GatherThreads::Finish(uint64_t job) {
  const MutexLock lock(mutex_);
  while (!jobs_.empty() && jobs_.front().number <= job) {
    if (Job* waiting = Waiting(); waiting != nullptr && waiting->number <= job) {
      RunPart(waiting);
    } else {
      done_.WaitUntil(mutex_, Now() + kLong);
    }
  }
}

double GatherThreads::seconds() const {
  const MutexLock lock(mutex_);
  return seconds_;
}

GatherThreads::Job* GatherThreads::Waiting() {
  const auto waiting = std::ranges::find_if(jobs_, [](const Job& j) { return j.taken < j.parts; });
  return waiting == jobs_.end() ? nullptr : &*waiting;
}

bool GatherThreads::RunPart(Job* job) {
  const int part = job->taken++;
  mutex_.Unlock();
  const SteadyTime start = Now();
  job->part(part);  // the job stays, because this part is not counted as run
  const double seconds = SecondsSince(start);
  mutex_.Lock();
  seconds_ += seconds;
  if (++job->run < job->parts) return false;
  jobs_.remove_if([job](const Job& other) { return &other == job; });
  done_.NotifyAll();
  return true;
}

void GatherThreads::Serve() {
  for (;;) {
    bool job_done = false;
    {
      const MutexLock lock(mutex_);
      while (!leaving_ && Waiting() == nullptr) work_.WaitUntil(mutex_, Now() + kLong);
      if (leaving_) return;
      job_done = RunPart(Waiting());
    }
    if (job_done && on_done_) on_done_();
  }
}

}  // namespace shoal::replay
