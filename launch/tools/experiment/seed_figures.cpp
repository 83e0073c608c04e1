// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/seed_figures.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/or_null.h"
#include "launch/tools/experiment/statistics_json.h"

namespace shoal::launch {
namespace {

using nlohmann::ordered_json;

constexpr double kAnything = std::numeric_limits<double>::infinity();

ordered_json MeanJson(const std::vector<double>& values, const std::optional<Interval>& interval,
                      size_t failed) {
  const auto mean = values.empty() ? std::nullopt : std::optional(Mean(values));
  return {{"mean", OrNull(mean)},
          {"ci95", IntervalJson(interval)},
          {"seeds", values.size()},
          {"failed", failed}};
}

// Digits after the point, 0 to 2: two significant digits of the interval's half width, or four
// significant digits of the mean if there is no interval.
int Digits(double mean, const std::optional<Interval>& interval) {
  const double half = interval ? (interval->high - interval->low) / 2 : 0;
  const double size = half > 0 ? half : std::abs(mean);
  if (size == 0) return 2;
  const int first = static_cast<int>(std::floor(std::log10(size)));
  return std::clamp((half > 0 ? 1 : 3) - first, 0, 2);
}

std::string FormatMean(const std::vector<double>& values, const std::optional<Interval>& interval,
                       size_t failed) {
  if (values.empty()) return failed > 0 ? fmt::format("- ({} failed)", failed) : "-";
  const double mean = Mean(values);
  const int digits = Digits(mean, interval);
  std::string text = fmt::format("{:.{}f}", mean, digits);
  if (interval) {
    text += fmt::format(" [{:.{}f}, {:.{}f}]", interval->low, digits, interval->high, digits);
  }
  text += fmt::format(" ({} seed{}", values.size(), values.size() == 1 ? "" : "s");
  if (failed > 0) text += fmt::format("; {} failed, left out", failed);
  return text + ")";
}

}  // namespace

void SeedFigures::Add(std::optional<double> success, size_t episodes, double return_mean,
                      std::optional<double> distance) {
  if (success && episodes > 0) {
    const double whole = std::round(*success * static_cast<double>(episodes));
    successes.push_back({static_cast<uint64_t>(whole), episodes});
  }
  returns.push_back(return_mean);
  if (distance) distances.push_back(*distance);
}

uint64_t SeedFigures::Successes() const {
  uint64_t sum = 0;
  for (const SeedSuccess& seed : successes) sum += seed.successes;
  return sum;
}

uint64_t SeedFigures::Episodes() const {
  uint64_t sum = 0;
  for (const SeedSuccess& seed : successes) sum += seed.episodes;
  return sum;
}

std::vector<double> SeedFigures::Rates() const {
  std::vector<double> rates;
  for (const SeedSuccess& seed : successes) rates.push_back(seed.Rate());
  return rates;
}

std::optional<double> SeedFigures::RateWithFailedAsZero() const {
  if (successes.empty()) return std::nullopt;
  std::vector<double> rates = Rates();
  rates.resize(rates.size() + failed, 0);
  return Mean(rates);
}

ordered_json SuccessJson(const SeedFigures& figures) {
  const uint64_t succeeded = figures.Successes(), episodes = figures.Episodes();
  const size_t seeds = figures.successes.size();
  std::optional<double> pooled, mean;
  std::optional<Interval> wilson;
  if (seeds > 0) {
    pooled = static_cast<double>(succeeded) / static_cast<double>(episodes);
    mean = Mean(figures.Rates());
  }
  if (seeds == 1) wilson = Wilson95(succeeded, episodes);
  return {{"pooled", OrNull(pooled)},
          {"episodes", episodes},
          {"mean", OrNull(mean)},
          {"seeds", seeds},
          {"ci95", IntervalJson(SuccessInterval95(figures.successes))},
          {"wilson95", IntervalJson(wilson)},
          {"failed", figures.failed},
          {"mean_with_failed_as_0", OrNull(figures.RateWithFailedAsZero())}};
}

ordered_json ReturnJson(const SeedFigures& figures) {
  return MeanJson(figures.returns, MeanInterval95(figures.returns), figures.failed);
}

ordered_json DistanceJson(const SeedFigures& figures) {
  return MeanJson(figures.distances, DistanceInterval95(figures.distances), figures.failed);
}

std::string FormatSuccess(const SeedFigures& figures) {
  const size_t seeds = figures.successes.size();
  if (seeds == 0) return "-";
  const uint64_t succeeded = figures.Successes(), episodes = figures.Episodes();
  const Interval interval =
      seeds == 1 ? Wilson95(succeeded, episodes) : *SuccessInterval95(figures.successes);
  std::string text = fmt::format("{:.1f} % [{:.1f}, {:.1f}] (", 100 * Mean(figures.Rates()),
                                 100 * interval.low, 100 * interval.high);
  if (seeds > 1) text += fmt::format("{} seeds, ", seeds);
  text += fmt::format("{}/{}", succeeded, episodes);
  if (figures.failed > 0) {
    text += fmt::format("; {} failed: {:.1f} % with {} as 0", figures.failed,
                        100 * *figures.RateWithFailedAsZero(), figures.failed == 1 ? "it" : "them");
  }
  return text + ")";
}

std::string FormatReturn(const SeedFigures& figures) {
  return FormatMean(figures.returns, MeanInterval95(figures.returns), figures.failed);
}

std::string FormatValue(double value) {
  std::string text = fmt::format("{:.{}f}", value, Digits(value, std::nullopt));
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text;
}

std::string FormatDistance(const SeedFigures& figures) {
  std::vector<double> centimetres;
  for (const double distance : figures.distances) centimetres.push_back(Centimetres(distance));
  return FormatMean(centimetres, DistanceInterval95(centimetres),
                    figures.distances.empty() ? 0 : figures.failed);
}

std::optional<Interval> DistanceInterval95(const std::vector<double>& distances) {
  const auto interval = MeanInterval95(distances);
  return interval ? std::optional(Within(*interval, 0, kAnything)) : std::nullopt;
}

}  // namespace shoal::launch
