// SPDX-License-Identifier: Apache-2.0
#include "replay_server/service/gather_threads.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <set>
#include <thread>
#include <vector>

namespace shoal::replay {
namespace {

using Part = std::function<void(int part)>;

void RunJob(GatherThreads& threads, int parts, const Part& part) {
  const uint64_t job = threads.Start(parts, part);
  threads.Finish(job);
  EXPECT_TRUE(threads.Done(job));
}

// How often each part of a job was run.
std::vector<int> Counts(GatherThreads& threads, int parts) {
  std::vector<std::atomic<int>> counts(static_cast<size_t>(parts));
  RunJob(threads, parts, [&](int part) { ++counts.at(static_cast<size_t>(part)); });
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

// Finish must not return while a helper is within a part, nor may a helper that wakes late touch
// the next job.
TEST(GatherThreads, ManyJobsInARowStayApart) {
  GatherThreads threads(4);
  for (int job = 0; job < 300; ++job) {
    std::vector<std::atomic<int>> counts(6);
    RunJob(threads, 6, [&](int part) {
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
  RunJob(threads, 2, [&](int) {
    ++inside;
    while (inside < 2) std::this_thread::yield();
  });
  EXPECT_EQ(inside, 2);
}

// The helper waits within the first job until the second job has begun.
TEST(GatherThreads, ThreadsGoOnWithTheNextJobBeforeTheFirstHasEnded) {
  GatherThreads threads(2);
  std::atomic<bool> first_begun{false}, second_begun{false};
  const uint64_t first = threads.Start(1, [&](int) {
    first_begun = true;
    while (!second_begun) std::this_thread::yield();
  });
  while (!first_begun) std::this_thread::yield();
  EXPECT_FALSE(threads.HasWork());
  EXPECT_FALSE(threads.Help()) << "a helper has taken the only part";
  const uint64_t second = threads.Start(1, [&](int) { second_begun = true; });
  EXPECT_FALSE(threads.Done(first));
  threads.Finish(second);
  EXPECT_TRUE(second_begun);
  EXPECT_TRUE(threads.Done(first) && threads.Done(second));
}

TEST(GatherThreads, TheOwnerAloneDoesAWholeJobAtATime) {
  GatherThreads threads;
  std::vector<int> run;
  const uint64_t first = threads.Start(2, [&](int part) { run.push_back(part); });
  const uint64_t second = threads.Start(1, [&](int part) { run.push_back(10 + part); });
  EXPECT_TRUE(threads.Done(threads.Start(0, nullptr))) << "no parts, no wait";
  EXPECT_TRUE(run.empty());
  EXPECT_TRUE(threads.HasWork());
  EXPECT_TRUE(threads.Help());
  EXPECT_EQ(run, (std::vector{0, 1}));
  EXPECT_TRUE(threads.Done(first));
  EXPECT_FALSE(threads.Done(second));
  EXPECT_TRUE(threads.Help());
  EXPECT_EQ(run, (std::vector{0, 1, 10}));
  EXPECT_FALSE(threads.HasWork());
  EXPECT_FALSE(threads.Help());
}

TEST(GatherThreads, AHelperTellsThatAJobIsDoneAndCountsItsTime) {
  std::atomic<int> told{0};
  GatherThreads threads(2, [&] { ++told; });
  EXPECT_EQ(threads.seconds(), 0);
  const uint64_t job =
      threads.Start(3, [&](int) { std::this_thread::sleep_for(std::chrono::milliseconds(2)); });
  while (told == 0) std::this_thread::yield();
  EXPECT_TRUE(threads.Done(job));
  EXPECT_GE(threads.seconds(), 0.006);
  threads.Resize(1);
  EXPECT_EQ(told, 1);
}

// The remaining threads run the parts that former helpers have not taken.
TEST(GatherThreads, NoPartIsLostWhenTheirNumberChanges) {
  GatherThreads threads(3);
  std::vector<std::atomic<int>> counts(60);
  const uint64_t job = threads.Start(60, [&](int part) {
    std::this_thread::sleep_for(std::chrono::microseconds(100));
    ++counts.at(static_cast<size_t>(part));
  });
  for (const int number : {1, 4, 2}) {
    threads.Help();
    threads.Resize(number);
  }
  threads.Finish(job);
  for (const std::atomic<int>& count : counts) EXPECT_EQ(count, 1);
}

TEST(GatherThreads, TheirNumberFollowsTheShareOfTheTimeThatCopyingTakes) {
  EXPECT_EQ(GatherThreadsFor(0.3, 1, 4), 1);
  EXPECT_EQ(GatherThreadsFor(0.6, 1, 4), 2);
  EXPECT_EQ(GatherThreadsFor(0.95, 2, 8), 4) << "with four threads, 0.475";
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
