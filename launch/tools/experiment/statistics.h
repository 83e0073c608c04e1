// SPDX-License-Identifier: Apache-2.0
// Intervals and ratios of experiments. Pure. The unit is the seed, because episodes of one training
// are not independent evidence about the method.
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

double Mean(std::span<const double> values);  // needs at least one value
// Standard deviation with n - 1 in the denominator; needs at least two values.
double SampleDeviation(std::span<const double> values);
// Needs at least one value; an even number of values gives the mean of the two middle values.
double Median(std::vector<double> values);

// The part of the interval within [low, high], for values that cannot be outside these bounds.
Interval Within(const Interval& interval, double low, double high);

// 95 % interval of a proportion from `successes` of `trials` > 0 (Wilson 1927, without continuity
// correction). The interval stays within 0..1 and has a positive width even if none or all of the
// trials succeed.
Interval Wilson95(uint64_t successes, uint64_t trials);

// 95 % interval of the mean of normally distributed values: mean -+ t(0.975, n - 1) s / sqrt(n).
// Empty for fewer than two values.
std::optional<Interval> MeanInterval95(std::span<const double> values);

// Successes of one trained policy.
struct SeedSuccess {
  uint64_t successes = 0, episodes = 0;  // episodes > 0

  double Rate() const { return static_cast<double>(successes) / static_cast<double>(episodes); }
};

// 95 % interval of a method's success rate from the policies of at least two seeds: Student's
// interval of the mean of their rates, limited to 0..1, and never narrower than Wilson's interval
// of all episodes together. Seeds that differ by more than chance widen the interval. Seeds that
// agree by chance (all at 100 %) do not make the interval narrower than the episodes allow. Empty
// for fewer than two seeds.
std::optional<Interval> SuccessInterval95(std::span<const SeedSuccess> seeds);

// Mean of the values between the quartiles: floor(n / 4) values are removed at each end (Agarwal et
// al. 2021, arXiv:2108.13264; scipy's trim_mean with 0.25). For fewer than four values, the result
// is the plain mean. Needs at least one value.
double InterquartileMean(std::vector<double> values);

// 95 % stratified percentile bootstrap of a statistic (arXiv:2108.13264, section 4.1; rliable's
// StratifiedBootstrap). Each resample draws n of the n values of each stratum with replacement; the
// statistic is computed from all drawn values. A stratum holds the runs of one task. The same seed
// gives the same interval. Empty without strata, or if a stratum has fewer than two values.
using Statistic = std::function<double(const std::vector<double>&)>;
std::optional<Interval> StratifiedBootstrap95(const std::vector<std::vector<double>>& strata,
                                              const Statistic& statistic, uint64_t seed = 1,
                                              int resamples = 10'000);

// 95 % bootstrap interval of the mean of one stratum (Efron 1979).
std::optional<Interval> BootstrapInterval95(std::span<const double> values, uint64_t seed = 1,
                                            int resamples = 10'000);

// Two-sided quantile of Student's t: P(|T| <= t) = 0.95 with `freedom` >= 1 degrees.
double StudentT95(int freedom);

// Env steps to the target of one seed, in an arm (`n`) and in the reference arm; empty = not
// reached.
struct RatioPair {
  int64_t seed = 0;
  std::optional<double> n{}, reference{};

  // Empty if either side did not reach the target.
  std::optional<double> Ratio() const;
};

struct SampleRatio {
  std::vector<RatioPair> pairs;
  int not_reached = 0;  // pairs with at least one side that did not reach the target
  // Median over all pairs. A pair ranks above every number if only the reference reached the
  // target, and below every number if only the arm reached the target. Empty if the median is such
  // a pair, if neither side of some pair reached the target, or if there are no pairs.
  std::optional<double> median;
};

SampleRatio RatioOf(std::vector<RatioPair> pairs);

// Result of one training for the computation of ratios.
struct TargetReached {
  int64_t seed = 0;
  bool over = false;          // finished or failed: the result is final
  std::optional<double> n{};  // env steps to the target; empty = not reached
};

// Ratio over the seeds whose runs are over in both the arm and the reference. A run that is not
// over is left out, because it may still reach the target.
SampleRatio RatioOfEnded(std::span<const TargetReached> arm,
                         std::span<const TargetReached> reference);

}  // namespace shoal::launch
