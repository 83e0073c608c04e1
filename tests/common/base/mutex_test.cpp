// SPDX-License-Identifier: Apache-2.0
#include "common/base/mutex.h"

#include <gtest/gtest.h>

#include <thread>

namespace shoal {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(ConditionVariable, EndsAtItsDeadlineWithTheMutexHeld) {
  Mutex mutex;
  ConditionVariable never;
  mutex.Lock();
  EXPECT_FALSE(never.WaitUntil(mutex, Now() + milliseconds(1)));
  mutex.Unlock();  // a mutex that was not held again would be undefined to unlock: seen under tsan
}

TEST(ConditionVariable, GivesUpTheMutexWhileItWaits) {
  Mutex mutex;
  ConditionVariable changed;
  bool ready = false;
  std::thread other([&] {
    const MutexLock lock(mutex);
    ready = true;
    changed.NotifyAll();
  });
  {
    const MutexLock lock(mutex);
    const SteadyTime deadline = Now() + seconds(10);
    while (!ready && changed.WaitUntil(mutex, deadline)) {
    }
    EXPECT_TRUE(ready);
  }
  other.join();
}

TEST(MutexLock, KeepsOtherThreadsOut) {
  Mutex mutex;
  int count = 0;
  const auto add = [&] {
    for (int i = 0; i < 20'000; ++i) {
      const MutexLock lock(mutex);
      ++count;
    }
  };
  std::thread other(add);
  add();
  other.join();
  EXPECT_EQ(count, 40'000);
}

}  // namespace
}  // namespace shoal
