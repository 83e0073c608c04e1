// SPDX-License-Identifier: Apache-2.0
// Expected values are scipy 1.10's (stats.t, binomtest(...).proportion_ci(method='wilson')) where
// no other source is given.
#include "launch/experiment/statistics.h"

#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

const std::vector<double> kReturns = {1481, 2820, 2102, 1900, 2500};

TEST(Statistics, StudentsQuantilesAreThePublishedOnes) {
  EXPECT_NEAR(StudentT95(1), 12.706204736432095, 1e-8);
  EXPECT_NEAR(StudentT95(2), 4.302652729911275, 1e-9);
  EXPECT_NEAR(StudentT95(3), 3.182446305284263, 1e-9);
  EXPECT_NEAR(StudentT95(4), 2.7764451051977987, 1e-9);
  EXPECT_NEAR(StudentT95(9), 2.2621571627409915, 1e-9);
  EXPECT_NEAR(StudentT95(30), 2.0422724563012373, 1e-9);
}

TEST(Statistics, TheIntervalOfAMeanIsStudents) {
  EXPECT_DOUBLE_EQ(Mean(kReturns), 2160.6);
  EXPECT_NEAR(SampleDeviation(kReturns), 520.3852419121819, 1e-9);
  const auto interval = MeanInterval95(kReturns);
  ASSERT_TRUE(interval);
  EXPECT_NEAR(interval->low, 1514.456379921086, 1e-6);
  EXPECT_NEAR(interval->high, 2806.743620078914, 1e-6);
  EXPECT_FALSE(MeanInterval95(std::vector<double>{1.0})) << "one seed has no spread";
}

// By hand: two values 0 and 2 have mean 1, s = sqrt(2), t(1) = 12.706: 1 -+ 12.706.
TEST(Statistics, TheIntervalOfTwoValuesByHand) {
  const auto interval = MeanInterval95(std::vector<double>{0, 2});
  ASSERT_TRUE(interval);
  EXPECT_NEAR(interval->high, 13.706204736, 1e-6);
}

TEST(Statistics, WilsonsIntervalStaysWithinTheRates) {
  EXPECT_EQ(Wilson95(0, 50).low, 0);
  EXPECT_NEAR(Wilson95(0, 50).high, 0.07134759913335872, 1e-12);
  EXPECT_NEAR(Wilson95(50, 50).low, 0.9286524008666412, 1e-12);
  EXPECT_EQ(Wilson95(50, 50).high, 1);
  EXPECT_NEAR(Wilson95(292, 300).low, 0.9482710570494102, 1e-12);
  EXPECT_NEAR(Wilson95(292, 300).high, 0.9864269301913529, 1e-12);
  EXPECT_NEAR(Wilson95(7, 10).low, 0.39677814746114526, 1e-12);
  EXPECT_NEAR(Wilson95(7, 10).high, 0.892208732593699, 1e-12);
}

// 100,000 resamples of numpy's: [1768.6, 2564.0]. The standard error of such a quantile over 10,000
// resamples is sqrt(p (1 - p) / 10,000) / density, here about 7; the tolerance is 5 of them.
TEST(Statistics, TheBootstrapIsThatOfTheMean) {
  const auto interval = BootstrapInterval95(kReturns);
  ASSERT_TRUE(interval);
  EXPECT_NEAR(interval->low, 1768.6, 35);
  EXPECT_NEAR(interval->high, 2564.0, 35);
  const auto again = BootstrapInterval95(kReturns);
  EXPECT_EQ(interval->low, again->low) << "the same seed, the same interval";
  EXPECT_FALSE(BootstrapInterval95(std::vector<double>{1.0}));
  const auto level = BootstrapInterval95(std::vector<double>{3, 3, 3});
  EXPECT_EQ(level->low, 3);
  EXPECT_EQ(level->high, 3);
}

TEST(Statistics, MedianOfOddAndEven) {
  EXPECT_EQ(Median({3, 1, 2}), 2);
  EXPECT_EQ(Median({4, 1, 2, 3}), 2.5);
}

TEST(SampleRatio, IsPairedBySeed) {
  const SampleRatio ratio = RatioOf({{0, 300, 100}, {1, 200, 100}, {2, 50, 100}});
  EXPECT_EQ(ratio.not_reached, 0);
  EXPECT_EQ(ratio.median, 2);
}

TEST(SampleRatio, WhatWasNotReachedIsCountedNotDropped) {
  // Of 1, 2 and "never" the middle is 2; without the third it would be 1.5.
  SampleRatio ratio = RatioOf({{0, 100, 100}, {1, 200, 100}, {2, std::nullopt, 100}});
  EXPECT_EQ(ratio.not_reached, 1);
  EXPECT_EQ(ratio.median, 2);
  // The reference never got there: the arm's ratio is below every number.
  ratio = RatioOf({{0, 100, 100}, {1, 200, 100}, {2, 100, std::nullopt}});
  EXPECT_EQ(ratio.not_reached, 1);
  EXPECT_EQ(ratio.median, 1);
  // The middle itself is not a number.
  ratio = RatioOf({{0, 100, 100}, {1, std::nullopt, 100}, {2, std::nullopt, 100}});
  EXPECT_EQ(ratio.not_reached, 2);
  EXPECT_EQ(ratio.median, std::nullopt);
  // Neither got there: nothing can be said of that seed.
  ratio = RatioOf({{0, 100, 100}, {1, 100, 100}, {2, std::nullopt, std::nullopt}});
  EXPECT_EQ(ratio.not_reached, 1);
  EXPECT_EQ(ratio.median, std::nullopt);
  EXPECT_EQ(RatioOf({}).median, std::nullopt);
}

TEST(SampleRatio, WhatIsStillToBeDoneHasNotFailedToReachAnything) {
  const std::vector<TargetReached> arm{{0, true, 200},
                                       {1, false, std::nullopt},
                                       {2, true, 300},
                                       {3, true, std::nullopt},
                                       {4, true, 100}};
  const std::vector<TargetReached> reference{
      {3, true, 100}, {2, false, 100}, {1, true, 100}, {0, true, 100}};
  const SampleRatio ratio = RatioOfFinished(arm, reference);
  ASSERT_EQ(ratio.pairs.size(), 2u);
  EXPECT_EQ(ratio.pairs[0].seed, 0);
  EXPECT_EQ(ratio.pairs[0].Ratio(), 2);
  EXPECT_EQ(ratio.pairs[1].seed, 3);
  EXPECT_EQ(ratio.not_reached, 1);
}

}  // namespace
}  // namespace shoal::launch
