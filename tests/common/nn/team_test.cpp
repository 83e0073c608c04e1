// SPDX-License-Identifier: Apache-2.0
#include "common/nn/team.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace shoal::nn {
namespace {

// More threads than cores, so that some threads sleep.
TEST(Barrier, ShowsEachWhatAllWroteBefore) {
  constexpr int kParties = 5, kRounds = 300;
  Barrier barrier(kParties);
  std::vector<int> written(kParties);
  std::vector<int> wrong(kParties);
  std::vector<std::thread> threads;
  for (size_t own = 0; own < kParties; ++own) {
    threads.emplace_back([&, own] {
      for (int round = 1; round <= kRounds; ++round) {
        written[own] = round;
        barrier.ArriveAndWait();
        for (const int value : written) wrong[own] += value != round;
        barrier.ArriveAndWait();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(kParties));
}

TEST(Barrier, OfOneHoldsNobodyUp) {
  Barrier barrier(1);
  for (int i = 0; i < 3; ++i) barrier.ArriveAndWait();
}

TEST(Team, RunsEveryRankOnceOnTheSameThreadEachTime) {
  for (const int ranks : {1, 2, 4}) {
    Team team(ranks);
    auto first = std::vector<std::thread::id>(size_t(ranks));
    std::vector<int> runs(first.size());
    for (int i = 0; i < 20; ++i) {
      team.Run([&](int rank) {
        if (i == 0) first[size_t(rank)] = std::this_thread::get_id();
        runs[size_t(rank)] += std::this_thread::get_id() == first[size_t(rank)];
      });
      EXPECT_EQ(runs, std::vector<int>(size_t(ranks), i + 1)) << "all are done";
    }
    EXPECT_EQ(first[0], std::this_thread::get_id());
    for (size_t r = 1; r < first.size(); ++r) EXPECT_NE(first[r], first[r - 1]);
  }
}

}  // namespace
}  // namespace shoal::nn
