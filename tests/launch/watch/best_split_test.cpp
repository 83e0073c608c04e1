// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/best_split.h"

#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

// An update of 26 ms for each eighth env step of 2 ms, as on 16 cores of a Xeon.
CoreCosts Flagship() {
  return {.env_step = 2e-3, .update = 26e-3, .updates_per_env_step = 0.125, .servers = 0.4e-3};
}

TEST(BestSplit, ThePaceIsThatOfTheSlowerSide) {
  const CoreCosts costs{.env_step = 0.01,
                        .update = 0.1,
                        .updates_per_env_step = 0.1,
                        .servers = 0,
                        .further_thread = 0};
  EXPECT_DOUBLE_EQ(PaceOf(costs, {.actors = 1, .threads = 2}), 100) << "of the actor";
  EXPECT_DOUBLE_EQ(PaceOf(costs, {.actors = 9, .threads = 2}), 200) << "of the learner";
}

TEST(BestSplit, AFurtherThreadAddsToTheUpdate) {
  EXPECT_NEAR(UpdatesPerSecond(Flagship(), 1), 38.5, 0.1);
  EXPECT_NEAR(UpdatesPerSecond(Flagship(), 8) / UpdatesPerSecond(Flagship(), 1), 8 / 1.21, 1e-9);
}

TEST(BestSplit, ThreadsActorsAndServersHaveACoreEach) {
  const SplitLimits limits{.cores = 16, .most_threads = 16};
  const Split best = BestSplit(Flagship(), limits);
  EXPECT_EQ(best, (Split{.actors = 6, .threads = 10}));
  const auto busy = [&](const Split& split) {
    const double pace = PaceOf(Flagship(), split);
    return split.threads + pace * (Flagship().env_step + Flagship().servers);
  };
  EXPECT_LE(busy(best), 16);
  EXPECT_GT(busy({.actors = 6, .threads = 12}), 16) << "it would not fit";
}

TEST(BestSplit, NoDivisionThatFitsIsFaster) {
  for (const int cores : {4, 7, 16, 64}) {
    const SplitLimits limits{.cores = cores, .most_threads = 16};
    const double best = PaceOf(Flagship(), BestSplit(Flagship(), limits));
    for (int threads = 1; threads <= 16; ++threads) {
      for (int actors = 1; actors + threads <= cores; ++actors) {
        const double pace = PaceOf(Flagship(), {.actors = actors, .threads = threads});
        const double busy = threads + pace * (Flagship().env_step + Flagship().servers);
        if (busy > cores) continue;
        // Each thread that is left out would have gained less than kWorth.
        EXPECT_LE(pace, best * kWorth * 1.001) << cores << ": " << actors << ", " << threads;
      }
    }
  }
}

TEST(BestSplit, ThreadsThatGainNothingAreLeftOut) {
  CoreCosts costs = Flagship();
  costs.further_thread = 1;
  EXPECT_EQ(BestSplit(costs, {.cores = 16, .most_threads = 16}).threads, 1);
}

TEST(BestSplit, GivenNumbersStay) {
  const Split actors = BestSplit(Flagship(), {.cores = 16, .most_threads = 16, .actors = 9});
  EXPECT_EQ(actors.actors, 9);
  EXPECT_GT(actors.threads, 1);
  const Split threads = BestSplit(Flagship(), {.cores = 16, .most_threads = 16, .threads = 3});
  EXPECT_EQ(threads, (Split{.actors = 3, .threads = 3}));
}

TEST(BestSplit, WhereNothingFitsThereIsOneOfEach) {
  CoreCosts costs = Flagship();
  costs.servers = 1;
  EXPECT_EQ(BestSplit(costs, {.cores = 4, .most_threads = 16}), (Split{1, 1}));
}

}  // namespace
}  // namespace shoal::launch
