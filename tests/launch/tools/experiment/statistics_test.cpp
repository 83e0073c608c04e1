// SPDX-License-Identifier: Apache-2.0
// Expected values are scipy 1.10's (stats.t, binomtest(...).proportion_ci(method='wilson')) where
// no other source is given.
#include "launch/tools/experiment/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

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
  EXPECT_FALSE(BootstrapInterval95(std::vector<double>{1.0}));
  const auto level = BootstrapInterval95(std::vector<double>{3, 3, 3});
  EXPECT_EQ(level->low, 3);
  EXPECT_EQ(level->high, 3);
}

// Values without a pattern: two seeds of the bootstrap hardly give the same quantile of their
// means.
TEST(Statistics, TheSameSeedGivesTheSameBootstrap) {
  std::vector<double> values;
  for (int i = 1; i <= 30; ++i) values.push_back(std::sqrt(i) * (i % 7));
  const auto first = BootstrapInterval95(values, 1), again = BootstrapInterval95(values, 1);
  EXPECT_EQ(first->low, again->low);
  EXPECT_EQ(first->high, again->high);
  const auto other = BootstrapInterval95(values, 2);
  EXPECT_NE(first->low, other->low);
  EXPECT_NE(first->high, other->high);
}

// Three seeds with 399, 384 and 375 of 400: they differ by more than chance (chi-squared, p =
// 2e-5), so that Wilson's interval of the 1,200 together, 95.3 to 97.4 %, says too much. Expected:
// scipy's t interval of the three rates, 88.97 to 104.03 %, as far as rates go.
TEST(SuccessInterval, SeedsThatDifferWidenIt) {
  const auto interval =
      SuccessInterval95(std::vector<SeedSuccess>{{399, 400}, {384, 400}, {375, 400}});
  ASSERT_TRUE(interval);
  EXPECT_NEAR(interval->low, 0.889704, 1e-6);
  EXPECT_EQ(interval->high, 1);
  const Interval wilson = Wilson95(1158, 1200);
  EXPECT_NEAR(wilson.low, 0.953029, 1e-6);
  EXPECT_GT(wilson.low - interval->low, 0.06);
}

// 396, 395, 394: closer together than chance lets them be. t interval: 98.129 to 99.371 %;
// Wilson's: 97.948 to 99.241 %.
TEST(SuccessInterval, SeedsThatAgreeByChanceDoNotNarrowIt) {
  const auto close =
      SuccessInterval95(std::vector<SeedSuccess>{{396, 400}, {395, 400}, {394, 400}});
  EXPECT_NEAR(close->low, 0.979478, 1e-6);
  EXPECT_NEAR(close->high, 0.993710, 1e-6);
  const auto all = SuccessInterval95(std::vector<SeedSuccess>{{100, 100}, {100, 100}, {100, 100}});
  EXPECT_NEAR(all->low, Wilson95(300, 300).low, 1e-12);
  EXPECT_EQ(all->high, 1);
}

TEST(SuccessInterval, OneSeedSaysNothingOfAMethod) {
  EXPECT_FALSE(SuccessInterval95(std::vector<SeedSuccess>{{399, 400}}));
  EXPECT_FALSE(SuccessInterval95({}));
}

// Expected: scipy.stats.trim_mean(values, 0.25).
TEST(InterquartileMean, CutsOffAQuarterAtEachEnd) {
  EXPECT_DOUBLE_EQ(InterquartileMean({7}), 7);
  EXPECT_DOUBLE_EQ(InterquartileMean({9, 0, 3}), 4) << "below four values nothing is cut off";
  EXPECT_DOUBLE_EQ(InterquartileMean({100, 2, 4, -50}), 3);
  EXPECT_DOUBLE_EQ(InterquartileMean({100, 2, 4, -50, 3, 1}), 2.5);
  EXPECT_NEAR(InterquartileMean({0.1, 0.5, 0.55, 0.6, 0.7, 0.9, 1.0, 0.2, 0.65}), 0.6, 1e-12);
}

// Expected: rliable at 72fc16c, get_interval_estimates of aggregate_iqm, 100,000 repetitions. The
// tolerance is 5 standard errors of a quantile over 10,000 resamples, as below.
TEST(StratifiedBootstrap, IsThatOfRliable) {
  const std::vector<double> runs{0.1, 0.5, 0.55, 0.6, 0.7, 0.9, 1.0, 0.2, 0.65};
  const auto one_task = StratifiedBootstrap95({runs}, InterquartileMean);
  ASSERT_TRUE(one_task);
  EXPECT_NEAR(one_task->low, 0.36, 0.02);
  EXPECT_NEAR(one_task->high, 0.79, 0.02);
  const auto two_tasks =
      StratifiedBootstrap95({{1, 2, 3, 4, 50}, {10, 20, 30, 40, 5}}, InterquartileMean);
  ASSERT_TRUE(two_tasks);
  EXPECT_NEAR(two_tasks->low, 4.5, 0.4);
  EXPECT_NEAR(two_tasks->high, 28.33, 1.7);
}

// By hand: one value a stratum is drawn from {0} and one from {1}, so that the mean of each
// resample is 1/2; without strata it would be 0 to 1.
TEST(StratifiedBootstrap, DrawsFromEachStratumItsOwnNumber) {
  const auto mean = [](const std::vector<double>& values) { return Mean(values); };
  const auto interval = StratifiedBootstrap95({{0, 0}, {1, 1}}, mean);
  EXPECT_EQ(interval->low, 0.5);
  EXPECT_EQ(interval->high, 0.5);
  EXPECT_FALSE(StratifiedBootstrap95({}, mean));
  EXPECT_FALSE(StratifiedBootstrap95({{0, 1}, {1}}, mean));
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
  // The median of 1, 2 and "never" is 2; without the third it would be 1.5.
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
  const SampleRatio ratio = RatioOfEnded(arm, reference);
  ASSERT_EQ(ratio.pairs.size(), 2u);
  EXPECT_EQ(ratio.pairs[0].seed, 0);
  EXPECT_EQ(ratio.pairs[0].Ratio(), 2);
  EXPECT_EQ(ratio.pairs[1].seed, 3);
  EXPECT_EQ(ratio.not_reached, 1);
}

}  // namespace
}  // namespace shoal::launch
