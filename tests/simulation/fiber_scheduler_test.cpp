// SPDX-License-Identifier: Apache-2.0
#include "tests/simulation/fiber_scheduler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/base/mutex.h"
#include "common/base/sleep.h"
#include "tests/support/temporary_folder.h"

namespace shoal::simulation {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::ElementsAre;

constexpr SteadyTime kStart{};

class FiberSchedulerTest : public testing::Test {
 protected:
  std::string Log(const char* name) const { return (folder_.path() / name).string(); }

  TemporaryFolder folder_;
  FiberScheduler scheduler_{1, 1'000'000'000};
  ThreadGroup one_{"one-0", Log("one")}, two_{"two-0", Log("two")};
};

TEST_F(FiberSchedulerTest, SleepersWakeInOrderAndTimeStandsStillMeanwhile) {
  std::vector<std::string> woke;
  double first = 0;
  scheduler_.StartIn(&one_, [&] {
    const SteadyTime start = Now();
    SleepFor(seconds(20));
    woke.push_back("late");
    first = SecondsSince(start);
  });
  scheduler_.StartIn(&two_, [&] {
    SleepFor(seconds(10));
    woke.push_back("early");
  });
  scheduler_.RunUntil(kStart + seconds(100));
  EXPECT_THAT(woke, ElementsAre("early", "late"));
  EXPECT_NEAR(first, 20, 1e-3);
  EXPECT_EQ(scheduler_.Alive(&one_), 0);
}

TEST_F(FiberSchedulerTest, AWaitEndsByNotificationOrByItsDeadline) {
  Mutex mutex;
  ConditionVariable changed;
  bool set = false;
  std::vector<bool> notified;
  scheduler_.StartIn(&one_, [&] {
    const MutexLock lock(mutex);
    while (!set) notified.push_back(changed.WaitUntil(mutex, Now() + seconds(5)));
  });
  scheduler_.StartIn(&two_, [&] {
    SleepFor(seconds(12));
    const MutexLock lock(mutex);
    set = true;
    changed.NotifyAll();
  });
  scheduler_.RunUntil(kStart + seconds(100));
  EXPECT_THAT(notified, ElementsAre(false, false, true));
}

TEST_F(FiberSchedulerTest, AMutexIsHeldAcrossASleep) {
  Mutex mutex;
  std::vector<int> order;
  for (const int i : {1, 2}) {
    scheduler_.StartIn(&one_, [&, i] {
      const MutexLock lock(mutex);
      order.push_back(i);
      SleepFor(seconds(1));
      order.push_back(i);
    });
  }
  scheduler_.RunUntil(kStart + seconds(10));
  ASSERT_EQ(order.size(), 4u);
  EXPECT_EQ(order[0], order[1]);
  EXPECT_EQ(order[2], order[3]);
}

TEST_F(FiberSchedulerTest, AThreadIsJoinedAndBelongsToTheGroupOfItsMaker) {
  const ThreadGroup* group = nullptr;
  bool joined = false;
  scheduler_.StartIn(&two_, [&] {
    Thread thread([&] {
      SleepFor(seconds(3));
      group = ThreadGroup::Current();
    });
    EXPECT_TRUE(thread.joinable());
    thread.join();
    joined = true;
    EXPECT_FALSE(thread.joinable());
  });
  scheduler_.RunUntil(kStart + seconds(10));
  EXPECT_TRUE(joined);
  EXPECT_EQ(group, &two_);
}

TEST_F(FiberSchedulerTest, AKilledProcessNeverRunsAgain) {
  int steps = 0;
  struct Tells {
    bool* destroyed;
    ~Tells() { *destroyed = true; }
  };
  bool destroyed = false;
  scheduler_.StartIn(&one_, [&] {
    const Tells tells{&destroyed};
    while (true) {
      ++steps;
      SleepFor(seconds(1));
    }
  });
  scheduler_.StartIn(&two_, [&] {
    SleepFor(milliseconds(2500));
    scheduler_.Kill(&one_);
  });
  scheduler_.RunUntil(kStart + seconds(10));
  EXPECT_EQ(steps, 3);
  EXPECT_FALSE(destroyed);
  EXPECT_EQ(scheduler_.Alive(&one_), 0);
}

TEST_F(FiberSchedulerTest, APausedProcessFindsThatTimeHasPassed) {
  double slept = 0;
  scheduler_.StartIn(&one_, [&] {
    const SteadyTime start = Now();
    SleepFor(seconds(1));
    slept = SecondsSince(start);
  });
  scheduler_.StartIn(&two_, [&] {
    SleepFor(milliseconds(500));
    scheduler_.Pause(&one_, Now() + seconds(30));
  });
  scheduler_.RunUntil(kStart + seconds(100));
  EXPECT_NEAR(slept, 30.5, 1e-3);
}

TEST_F(FiberSchedulerTest, ExceptionsInFlightAreTheFibersOwn) {
  std::vector<std::string> caught;
  for (const char* name : {"a", "b", "c"}) {
    scheduler_.StartIn(&one_, [&, name] {
      for (int i = 0; i < 20; ++i) {
        try {
          throw std::runtime_error(name);
        } catch (const std::exception&) {
          SleepFor(milliseconds(scheduler_.switches() % 7));
          try {
            throw;  // the one that this fiber handles
          } catch (const std::exception& again) {
            if (again.what() != std::string(name)) caught.push_back(again.what());
          }
        }
      }
    });
  }
  scheduler_.RunUntil(kStart + seconds(10));
  EXPECT_TRUE(caught.empty());
  EXPECT_EQ(scheduler_.Alive(&one_), 0);
}

TEST_F(FiberSchedulerTest, TheWallClockJumpsAndTheSteadyOneDoesNot) {
  int64_t wall = 0;
  double steady = 0;
  scheduler_.StartIn(&one_, [&] {
    const int64_t before = WallTimeNs();
    const SteadyTime start = Now();
    scheduler_.MoveWallClock(-seconds(3600));
    SleepFor(seconds(1));
    wall = WallTimeNs() - before;
    steady = SecondsSince(start);
  });
  scheduler_.RunUntil(kStart + seconds(10));
  EXPECT_NEAR(static_cast<double>(wall), -3599e9, 1e6);
  EXPECT_NEAR(steady, 1, 1e-3);
}

// Each fiber would sleep for a millisecond a hundred times.
TEST_F(FiberSchedulerTest, OneFiberStallsAndASlowProcessTakesItsTimeForEachTurn) {
  std::vector<double> ended(3);
  const auto work = [&](int which) {
    for (int i = 0; i < 100; ++i) SleepFor(milliseconds(1));
    ended[static_cast<size_t>(which)] = std::chrono::duration<double>(Now() - kStart).count();
  };
  scheduler_.StartIn(&one_, [&] { work(0); });
  scheduler_.StartIn(&one_, [&] { work(1); });
  scheduler_.StartIn(&two_, [&] { work(2); });
  scheduler_.Stall(&one_, /*which=*/1, kStart + seconds(7));
  scheduler_.SlowDown(&two_, milliseconds(20), kStart + seconds(1));
  scheduler_.RunUntil(kStart + seconds(100));
  EXPECT_NEAR(ended[0], 0.1, 0.01);
  EXPECT_NEAR(ended[1], 7.1, 0.01);
  EXPECT_NEAR(ended[2], 1.05, 0.02) << "50 slow turns, then 50 of the usual length";
}

// Three fibers take a mutex in turns; the result is the order, and the hash of the trace.
std::pair<std::string, uint64_t> Play(uint64_t seed, ThreadGroup* group) {
  FiberScheduler scheduler(seed, 0);
  Mutex mutex;
  std::string order;
  for (const char name : {'a', 'b', 'c'}) {
    scheduler.StartIn(group, [&, name] {
      for (int i = 0; i < 10; ++i) {
        SleepFor(milliseconds(1));
        const MutexLock lock(mutex);
        order += name;
      }
    });
  }
  scheduler.RunUntil(kStart + seconds(10));
  return {order, scheduler.TraceHash()};
}

TEST_F(FiberSchedulerTest, ASeedRepeatsAndAnotherOneTriesAnotherOrder) {
  const auto first = Play(7, &one_);
  EXPECT_EQ(first, Play(7, &one_));
  EXPECT_NE(first.first, Play(8, &one_).first);
  EXPECT_NE(first.second, Play(8, &one_).second);
  EXPECT_EQ(first.first.size(), 30u);
}

}  // namespace
}  // namespace shoal::simulation
