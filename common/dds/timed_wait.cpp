// SPDX-License-Identifier: Apache-2.0
// Replaces libc's pthread_cond_timedwait by a wait on the steady clock; steady_waits.h says why.
// This file is also a library of its own, which the loader puts before libc in the actor of the
// Python package.
#include <pthread.h>

#include <ctime>

#include "common/dds/steady_waits.h"

// The thread sanitizer has its own version and would not see this one.
#if !defined(__SANITIZE_THREAD__)

namespace {

constexpr long kNsPerSecond = 1'000'000'000;
// A condition variable may also use the steady clock, which counts from the machine's start. Times
// before 2001 are taken for times of the steady clock.
constexpr time_t kWallClockFrom = 1'000'000'000;

timespec Sum(const timespec& a, const timespec& b) {
  timespec sum{a.tv_sec + b.tv_sec, a.tv_nsec + b.tv_nsec};
  if (sum.tv_nsec >= kNsPerSecond) {
    ++sum.tv_sec;
    sum.tv_nsec -= kNsPerSecond;
  }
  return sum;
}

timespec Difference(const timespec& a, const timespec& b) {
  timespec difference{a.tv_sec - b.tv_sec, a.tv_nsec - b.tv_nsec};
  if (difference.tv_nsec < 0) {
    --difference.tv_sec;
    difference.tv_nsec += kNsPerSecond;
  }
  return difference;
}

}  // namespace

extern "C" int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex,
                                      const timespec* deadline) {
  if (deadline->tv_sec < kWallClockFrom) {
    return pthread_cond_clockwait(condition, mutex, CLOCK_MONOTONIC, deadline);
  }
  timespec wall{}, steady{};
  clock_gettime(CLOCK_REALTIME, &wall);
  clock_gettime(CLOCK_MONOTONIC, &steady);
  timespec until = Sum(steady, Difference(*deadline, wall));
  if (until.tv_sec < 0) until = {0, 0};
  return pthread_cond_clockwait(condition, mutex, CLOCK_MONOTONIC, &until);
}

#endif

namespace shoal::dds {

void LinkTimedWait() {}

}  // namespace shoal::dds
