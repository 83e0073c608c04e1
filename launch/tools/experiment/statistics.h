// SPDX-License-Identifier: Apache-2.0
// Intervals and ratios of experiments. Pure. Seeds are the unit: the episodes of one training are
// no independent evidence about the method.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace shoal::launch {

struct Interval {
  double low = 0, high = 0;
};

double Mean(std::span<const double> values);  // of at least one
// Standard deviation with n - 1 in the denominator; needs at least two values.
double SampleDeviation(std::span<const double> values);
// Needs at least one value; for an even number of values the mean of the two in the middle.
double Median(std::vector<double> values);

// The part of the interval that lies within [low, high]: where a figure cannot be outside of them.
Interval Within(const Interval& interval, double low, double high);

// 95 % interval of a proportion from `successes` of `trials` > 0 (Wilson 1927, without continuity
// correction): never outside 0..1, of a width above 0 for 0 and for all.
Interval Wilson95(uint64_t successes, uint64_t trials);

// 95 % interval of the mean of normally distributed values: mean -+ t(0.975, n - 1) s / sqrt(n).
// Empty for fewer than two values.
std::optional<Interval> MeanInterval95(std::span<const double> values);

// One trained policy: how many of its episodes succeeded.
struct SeedSuccess {
  uint64_t successes = 0, episodes = 0;  // episodes > 0

  double Rate() const { return static_cast<double>(successes) / static_cast<double>(episodes); }
};

// 95 % interval of a method's success rate from the policies of at least two seeds: Student's
// interval of the mean of their rates, cut off at 0 and 1, and never narrower than Wilson's
// interval of all episodes together. Seeds that differ by more than chance widen it; seeds that
// agree by chance (all at 100 %) do not make it narrower than the episodes allow. Empty for fewer
// than two seeds.
std::optional<Interval> SuccessInterval95(std::span<const SeedSuccess> seeds);

// Mean of the values between the quartiles: floor(n / 4) values are cut off at each end (Agarwal et
// al. 2021, arXiv:2108.13264; scipy's trim_mean with 0.25). The mean for fewer than four values. Of
// at least one value.
double InterquartileMean(std::vector<double> values);

// 95 % stratified percentile bootstrap of a statistic (arXiv:2108.13264, section 4.1; rliable's
// StratifiedBootstrap): each resample draws n of the n values of each stratum with replacement, and
// the statistic is of all that were drawn together. A stratum holds the runs of one task. The same
// seed gives the same interval. Empty without strata, or where one has fewer than two values.
using Statistic = std::function<double(const std::vector<double>&)>;
std::optional<Interval> StratifiedBootstrap95(const std::vector<std::vector<double>>& strata,
                                              const Statistic& statistic, uint64_t seed = 1,
                                              int resamples = 10'000);

// The same of the mean of one stratum (Efron 1979).
std::optional<Interval> BootstrapInterval95(std::span<const double> values, uint64_t seed = 1,
                                            int resamples = 10'000);

// Two-sided quantile of Student's t: P(|T| <= t) = 0.95 with `freedom` >= 1 degrees.
double StudentT95(int freedom);

// One seed's env steps to the target in an arm and in the one it is compared with; empty = not
// reached.
struct RatioPair {
  int64_t seed = 0;
  std::optional<double> n{}, reference{};

  // Empty where either was not reached.
  std::optional<double> Ratio() const;
};

struct SampleRatio {
  std::vector<RatioPair> pairs;
  int not_reached = 0;  // pairs of which at least one side did not reach the target
  // Over all pairs: one that did not reach the target counts as above every number where the arm
  // did not reach it, below every number where the reference did not. Empty where the middle falls
  // on such a pair, where neither side reached it, or without pairs.
  std::optional<double> median;
};

SampleRatio RatioOf(std::vector<RatioPair> pairs);

// One training as ratios see it.
struct TargetReached {
  int64_t seed = 0;
  bool over = false;          // finished or failed: it will not reach anything any more
  std::optional<double> n{};  // env steps to the target; empty = not reached
};

// Seeds of which the runs of both the arm and the reference are over: one that is still to be done
// has not failed to reach anything.
SampleRatio RatioOfEnded(std::span<const TargetReached> arm,
                         std::span<const TargetReached> reference);

}  // namespace shoal::launch
