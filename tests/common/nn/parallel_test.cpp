// SPDX-License-Identifier: Apache-2.0
#include "common/nn/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "common/nn/precision.h"

namespace shoal::nn {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnceForAnySizeAndNumberOfThreads) {
  for (const int threads : {1, 2, 5}) {
    const ThreadScope scope(threads);
    for (const int n : {0, 1, 2, 3, 7, 100}) {
      auto visits = std::vector<int>(size_t(n));
      std::atomic<int> ranges = 0;
      ParallelFor(n, [&](int begin, int end) {
        ++ranges;
        for (int i = begin; i < end; ++i) ++visits[size_t(i)];
      });
      EXPECT_EQ(visits, std::vector<int>(size_t(n), 1));
      EXPECT_LE(ranges, threads);
    }
  }
}

TEST(ParallelFor, RunsOnAsManyThreadsAsTheScopeAllows) {
  const ThreadScope scope(3);
  std::atomic<int> ranges = 0;
  ParallelFor(300, [&](int, int) { ++ranges; });
  EXPECT_EQ(ranges, 3);
}

TEST(ThreadScope, HoldsForItsOwnThreadAndPutsTheFormerSizeBack) {
  const ThreadScope outer(2);
  std::atomic<int> ranges = 0;
  {
    const ThreadScope inner(4);
    std::thread([] { const ThreadScope other(1); }).join();
    ParallelFor(400, [&](int, int) { ++ranges; });
    EXPECT_EQ(ranges, 4);
  }
  ranges = 0;
  ParallelFor(400, [&](int, int) { ++ranges; });
  EXPECT_EQ(ranges, 2);
}

TEST(SetThreads, IsTheCallingThreadsOwn) {
  SetThreads(3);
  int seen = 0;
  std::thread([&] {
    seen = Threads();
    SetThreads(2);
  }).join();
  EXPECT_EQ(seen, 1);
  EXPECT_EQ(Threads(), 3);
}

}  // namespace
}  // namespace shoal::nn
