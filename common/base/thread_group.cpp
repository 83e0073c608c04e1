// SPDX-License-Identifier: Apache-2.0
#include "common/base/thread_group.h"

#include <ctime>

namespace shoal {
namespace {

thread_local ThreadGroup* current_group = nullptr;

double Seconds(clockid_t clock) {
  timespec time{};
  if (clock_gettime(clock, &time) != 0) return 0;
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

}  // namespace

ThreadGroup* ThreadGroup::Current() { return current_group; }

double ThreadGroup::CpuSeconds() const {
  const MutexLock lock(mutex_);
  double seconds = ended_seconds_;
  for (const pthread_t member : members_) {
    clockid_t clock{};
    if (pthread_getcpuclockid(member, &clock) == 0) seconds += Seconds(clock);
  }
  return seconds;
}

void ThreadGroup::Enter() {
  const MutexLock lock(mutex_);
  members_.push_back(pthread_self());
  ended_seconds_ -= Seconds(CLOCK_THREAD_CPUTIME_ID);
}

void ThreadGroup::Leave() {
  const MutexLock lock(mutex_);
  std::erase(members_, pthread_self());
  ended_seconds_ += Seconds(CLOCK_THREAD_CPUTIME_ID);
}

ThreadGroup::Bound::Bound(ThreadGroup* group) : former_(std::exchange(current_group, group)) {}

ThreadGroup::Bound::~Bound() { current_group = former_; }

ThreadGroup::Member::Member(ThreadGroup* group)
    : group_(group), former_(std::exchange(current_group, group)) {
  if (group_ != nullptr) group_->Enter();
}

ThreadGroup::Member::~Member() {
  if (group_ != nullptr) group_->Leave();
  current_group = former_;
}

}  // namespace shoal
