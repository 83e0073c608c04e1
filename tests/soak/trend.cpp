// SPDX-License-Identifier: Apache-2.0
#include "tests/soak/trend.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace shoal::soak {
namespace {

double MeanOf(const std::vector<double>& values) {
  if (values.empty()) return 0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

void Trend::Add(double seconds, double value) {
  seconds_.push_back(seconds);
  values_.push_back(value);
}

double Trend::Mean() const { return MeanOf(values_); }

double Trend::Spread() const {
  const double mean = MeanOf(seconds_);
  double sum = 0;
  for (const double t : seconds_) sum += (t - mean) * (t - mean);
  return sum;
}

double Trend::Slope() const {
  const double spread = Spread();
  if (spread <= 0) return 0;
  const double mean_t = MeanOf(seconds_), mean_v = Mean();
  double sum = 0;
  for (size_t i = 0; i < values_.size(); ++i) sum += (seconds_[i] - mean_t) * (values_[i] - mean_v);
  return sum / spread;
}

double Trend::Scale() const { return 600 * 100 / std::max(1.0, Mean()); }

double Trend::PercentPerTenMinutes() const { return Slope() * Scale(); }

double Trend::PercentError() const {
  if (samples() < 3) return 0;
  const double slope = Slope(), mean_t = MeanOf(seconds_), mean_v = Mean();
  double residuals = 0;
  for (size_t i = 0; i < values_.size(); ++i) {
    const double residual = values_[i] - mean_v - slope * (seconds_[i] - mean_t);
    residuals += residual * residual;
  }
  return std::sqrt(residuals / (samples() - 2) / Spread()) * Scale();
}

}  // namespace shoal::soak
