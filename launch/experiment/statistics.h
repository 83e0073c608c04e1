// SPDX-License-Identifier: Apache-2.0
// Intervals and ratios of experiments. Pure. Seeds are the unit: the episodes of one training are
// no independent evidence about the method.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace shoal::launch {

struct Interval {
  double low = 0, high = 0;
};

double Mean(std::span<const double> values);  // of at least one
// With n - 1; of at least two values.
double SampleDeviation(std::span<const double> values);
// Of at least one value; the mean of the two in the middle where there are as many on both sides.
double Median(std::vector<double> values);

// 95 % interval of a proportion from `successes` of `trials` > 0 (Wilson 1927, without continuity
// correction): never outside 0..1, of a width above 0 for 0 and for all.
Interval Wilson95(uint64_t successes, uint64_t trials);

// 95 % interval of the mean of normally distributed values: mean -+ t(0.975, n - 1) s / sqrt(n).
// Empty for fewer than two values.
std::optional<Interval> MeanInterval95(std::span<const double> values);

// 95 % percentile bootstrap of the mean (Efron 1979): 2.5 % and 97.5 % quantiles over `resamples`
// draws of n of n with replacement. The same seed gives the same interval. Empty for fewer than two
// values.
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
  bool finished = false;
  std::optional<double> n{};  // env steps to the target; empty = not reached
};

// Seeds of which the arm and the reference have a finished run: one that is still to be done has
// not failed to reach anything.
SampleRatio RatioOfFinished(std::span<const TargetReached> arm,
                            std::span<const TargetReached> reference);

}  // namespace shoal::launch
