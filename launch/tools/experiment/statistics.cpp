// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "common/base/check.h"
#include "common/base/random.h"

namespace shoal::launch {
namespace {

constexpr double kNormal95 = 1.959963984540054;  // P(|Z| <= z) = 0.95

// Continued fraction of the regularised incomplete beta function by Lentz's method (Press et al.,
// Numerical Recipes, section 6.4). Converges for x < (a + 1) / (a + b + 2).
double BetaFraction(double a, double b, double x) {
  constexpr double kTiny = 1e-300, kPrecision = 1e-15;
  const auto not_zero = [](double v) { return std::abs(v) < kTiny ? kTiny : v; };
  double c = 1, d = 1 / not_zero(1 - (a + b) * x / (a + 1)), result = d;
  for (int m = 1; m <= 10'000; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    double step = 1;
    for (const double term : {even, odd}) {
      d = 1 / not_zero(1 + term * d);
      c = not_zero(1 + term / c);
      step = c * d;
      result *= step;
    }
    if (std::abs(step - 1) < kPrecision) break;
  }
  return result;
}

// I_x(a, b), 0 <= x <= 1.
double IncompleteBeta(double a, double b, double x) {
  if (x <= 0 || x >= 1) return x <= 0 ? 0 : 1;
  const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1) / (a + b + 2)) return front * BetaFraction(a, b, x) / a;
  return 1 - front * BetaFraction(b, a, 1 - x) / b;
}

// P(|T| > t) of Student's t.
double TwoSidedTail(double t, int freedom) {
  return IncompleteBeta(freedom / 2.0, 0.5, freedom / (freedom + t * t));
}

double Quantile(const std::vector<double>& sorted, double p) {
  const double place = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<size_t>(place);
  const size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

double Mean(std::span<const double> values) {
  CHECK(!values.empty());
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double SampleDeviation(std::span<const double> values) {
  CHECK(values.size() >= 2);
  const double mean = Mean(values);
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

double Median(std::vector<double> values) {
  CHECK(!values.empty());
  std::ranges::sort(values);
  const size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

Interval Within(const Interval& interval, double low, double high) {
  return {std::clamp(interval.low, low, high), std::clamp(interval.high, low, high)};
}

Interval Wilson95(uint64_t successes, uint64_t trials) {
  CHECK(trials > 0 && successes <= trials);
  const auto n = static_cast<double>(trials);
  const double rate = static_cast<double>(successes) / n, z2 = kNormal95 * kNormal95;
  const double centre = (rate + z2 / (2 * n)) / (1 + z2 / n);
  const double half =
      kNormal95 / (1 + z2 / n) * std::sqrt(rate * (1 - rate) / n + z2 / (4 * n * n));
  // If an end is 0 or 1, use the exact value: rounding would leave an error of 1e-17.
  return {successes == 0 ? 0 : std::max(0.0, centre - half),
          successes == trials ? 1 : std::min(1.0, centre + half)};
}

double StudentT95(int freedom) {
  CHECK(freedom >= 1);
  double low = 0, high = 1000;  // t(0.975, 1) = 12.7 is the largest
  while (high - low > 1e-12 * high) {
    const double middle = (low + high) / 2;
    (TwoSidedTail(middle, freedom) > 0.05 ? low : high) = middle;
  }
  return (low + high) / 2;
}

std::optional<Interval> MeanInterval95(std::span<const double> values) {
  if (values.size() < 2) return std::nullopt;
  const double mean = Mean(values);
  const double half = StudentT95(static_cast<int>(values.size()) - 1) * SampleDeviation(values) /
                      std::sqrt(static_cast<double>(values.size()));
  return Interval{mean - half, mean + half};
}

std::optional<Interval> SuccessInterval95(std::span<const SeedSuccess> seeds) {
  if (seeds.size() < 2) return std::nullopt;
  std::vector<double> rates;
  SeedSuccess all;
  for (const SeedSuccess& seed : seeds) {
    CHECK(seed.episodes > 0);
    rates.push_back(seed.Rate());
    all.successes += seed.successes;
    all.episodes += seed.episodes;
  }
  const Interval student = Within(*MeanInterval95(rates), 0, 1);
  const Interval wilson = Wilson95(all.successes, all.episodes);
  return Interval{std::min(student.low, wilson.low), std::max(student.high, wilson.high)};
}

double InterquartileMean(std::vector<double> values) {
  CHECK(!values.empty());
  std::ranges::sort(values);
  const size_t cut = values.size() / 4;
  return Mean(std::span(values).subspan(cut, values.size() - 2 * cut));
}

std::optional<Interval> StratifiedBootstrap95(const std::vector<std::vector<double>>& strata,
                                              const Statistic& statistic, uint64_t seed,
                                              int resamples) {
  const auto too_few = [](const std::vector<double>& stratum) { return stratum.size() < 2; };
  if (strata.empty() || std::ranges::any_of(strata, too_few)) return std::nullopt;
  Random random(seed);
  std::vector<double> drawn, results(static_cast<size_t>(resamples));
  for (double& result : results) {
    drawn.clear();
    for (const std::vector<double>& stratum : strata) {
      for (size_t i = 0; i < stratum.size(); ++i) {
        drawn.push_back(stratum[random.Below(stratum.size())]);
      }
    }
    result = statistic(drawn);
  }
  std::ranges::sort(results);
  return Interval{Quantile(results, 0.025), Quantile(results, 0.975)};
}

std::optional<Interval> BootstrapInterval95(std::span<const double> values, uint64_t seed,
                                            int resamples) {
  return StratifiedBootstrap95(
      {{values.begin(), values.end()}},
      [](const std::vector<double>& drawn) { return Mean(drawn); }, seed, resamples);
}

std::optional<double> RatioPair::Ratio() const {
  if (!n || !reference || *reference == 0) return std::nullopt;
  return *n / *reference;
}

SampleRatio RatioOf(std::vector<RatioPair> pairs) {
  constexpr double kAbove = std::numeric_limits<double>::infinity();
  SampleRatio result;
  std::vector<double> ordered;
  bool comparable = !pairs.empty();
  for (const RatioPair& pair : pairs) {
    const auto ratio = pair.Ratio();
    if (!ratio) ++result.not_reached;
    if (!ratio && !pair.n && !pair.reference) comparable = false;
    ordered.push_back(ratio ? *ratio : pair.n ? -kAbove : kAbove);
  }
  result.pairs = std::move(pairs);
  if (!comparable) return result;
  const double median = Median(ordered);
  if (std::isfinite(median)) result.median = median;
  return result;
}

SampleRatio RatioOfEnded(std::span<const TargetReached> arm,
                         std::span<const TargetReached> reference) {
  std::vector<RatioPair> pairs;
  for (const TargetReached& run : arm) {
    const auto same = std::ranges::find(reference, run.seed, &TargetReached::seed);
    if (same == reference.end() || !run.over || !same->over) continue;
    pairs.push_back({run.seed, run.n, same->n});
  }
  return RatioOf(std::move(pairs));
}

}  // namespace shoal::launch
