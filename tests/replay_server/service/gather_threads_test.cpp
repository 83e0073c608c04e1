// SPDX-License-Identifier: Apache-2.0
#include "replay_server/service/gather_threads.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <set>
#include <thread>
#include <vector>

namespace shoal::replay {
namespace {

// How often each part of a job was run.
std::vector<int> Counts(GatherThreads& threads, int parts) {
  std::vector<std::atomic<int>> counts(static_cast<size_t>(parts));
  threads.Run(parts, [&](int part) { ++counts.at(static_cast<size_t>(part)); });
  return {counts.begin(), counts.end()};
}

TEST(GatherThreads, EachPartIsRunOnceByWhateverNumberOfThreads) {
  GatherThreads threads;
  for (const int number : {1, 3, 2, 8, 1}) {
    threads.Resize(number);
    EXPECT_EQ(threads.threads(), number);
    for (const int parts : {0, 1, 7, 100}) {
      EXPECT_EQ(Counts(threads, parts), std::vector<int>(static_cast<size_t>(parts), 1))
          << number << " threads, " << parts << " parts";
    }
  }
}

// Run must not return while a helper is within a part, nor may a helper that wakes late touch the
// next job.
TEST(GatherThreads, ManyJobsInARowStayApart) {
  GatherThreads threads(4);
  for (int job = 0; job < 300; ++job) {
    std::vector<std::atomic<int>> counts(6);
    threads.Run(6, [&](int part) {
      std::this_thread::sleep_for(std::chrono::microseconds(100));
      ++counts.at(static_cast<size_t>(part));
    });
    for (const std::atomic<int>& count : counts) ASSERT_EQ(count, 1) << "job " << job;
  }
}

// Each part waits until two threads are in the job: one thread alone would never return.
TEST(GatherThreads, ThreadsWorkSideBySide) {
  GatherThreads threads(2);
  std::atomic<int> inside{0};
  threads.Run(2, [&](int) {
    ++inside;
    while (inside < 2) std::this_thread::yield();
  });
  EXPECT_EQ(inside, 2);
}

TEST(GatherThreads, TheirNumberFollowsTheShareOfTheTimeThatCopyingTakes) {
  EXPECT_EQ(GatherThreadsFor(0.3, 1, 4), 1);
  EXPECT_EQ(GatherThreadsFor(0.6, 1, 4), 2);
  EXPECT_EQ(GatherThreadsFor(0.6, 4, 4), 4) << "no more than allowed";
  EXPECT_EQ(GatherThreadsFor(0.3, 2, 4), 2) << "one thread would need 0.6";
  EXPECT_EQ(GatherThreadsFor(0.1, 2, 4), 1);
  EXPECT_EQ(GatherThreadsFor(0.9, 3, 1), 1);
}

// A number that a rate of batches asked for is kept at that rate.
TEST(GatherThreads, ASteadyRateOfBatchesSettlesOnOneNumber) {
  for (double work = 0.05; work < 3; work += 0.05) {  // seconds a second, by one thread
    int threads = 1;
    for (int second = 0; second < 10; ++second) {
      threads = GatherThreadsFor(work / threads, threads, 8);
    }
    EXPECT_EQ(GatherThreadsFor(work / threads, threads, 8), threads) << work;
  }
}

}  // namespace
}  // namespace shoal::replay
