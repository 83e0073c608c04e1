// SPDX-License-Identifier: Apache-2.0
#include "common/dds/steady_waits.h"

#include <gtest/gtest.h>
#include <pthread.h>

#include <cerrno>
#include <ctime>

#include "common/base/clock.h"

namespace shoal::dds {
namespace {

// The seconds a wait takes until `offset` from now on the clock.
double Wait(clockid_t clock, long offset_ns) {
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  pthread_cond_t condition = PTHREAD_COND_INITIALIZER;
  timespec deadline{};
  clock_gettime(clock, &deadline);
  deadline.tv_nsec += offset_ns;
  for (; deadline.tv_nsec >= 1'000'000'000; deadline.tv_nsec -= 1'000'000'000) ++deadline.tv_sec;
  for (; deadline.tv_nsec < 0; deadline.tv_nsec += 1'000'000'000) --deadline.tv_sec;
  const SteadyTime start = Now();
  pthread_mutex_lock(&mutex);
  EXPECT_EQ(pthread_cond_timedwait(&condition, &mutex, &deadline), ETIMEDOUT);
  pthread_mutex_unlock(&mutex);
  return SecondsSince(start);
}

TEST(SteadyWaits, TheProgramsOwnVersionIsInUse) { RequireSteadyWaits(); }

TEST(SteadyWaits, AWallClockDeadlineIsKept) {
  const double waited = Wait(CLOCK_REALTIME, 50'000'000);
  EXPECT_GE(waited, 0.049);
  EXPECT_LT(waited, 5);
}

TEST(SteadyWaits, ADeadlineInThePastEndsAtOnce) { EXPECT_LT(Wait(CLOCK_REALTIME, -50'000'000), 5); }

TEST(SteadyWaits, ASteadyDeadlineIsKeptToo) {
  const double waited = Wait(CLOCK_MONOTONIC, 50'000'000);
  EXPECT_GE(waited, 0.049);
  EXPECT_LT(waited, 5);
}

}  // namespace
}  // namespace shoal::dds
