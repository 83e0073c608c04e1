// SPDX-License-Identifier: Apache-2.0
// A pthread_cond_timedwait on the steady clock in place of libc's: steady_waits.h says why. Also a
// library of its own, which the actor of the Python package has the loader bring in before libc.
#include <pthread.h>

#include <ctime>

#include "common/dds/steady_waits.h"

// The thread sanitizer brings its own version and would not see ours.
#if !defined(__SANITIZE_THREAD__)

namespace {

constexpr long kNsPerSecond = 1'000'000'000;
// Condition variables may also be set to the steady clock, which counts from the machine's start:
// times before 2001 are taken for its.
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
