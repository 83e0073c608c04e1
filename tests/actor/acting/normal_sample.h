// SPDX-License-Identifier: Apache-2.0
// Tests whether a sample comes from a normal distribution of given mean and deviation: its mean and
// its deviation must each be within five standard errors.
#pragma once

#include <cmath>
#include <vector>

namespace shoal::actor {

struct Moments {
  double mean = 0, deviation = 0;
};

inline Moments MomentsOf(const std::vector<double>& sample) {
  Moments moments;
  const auto n = static_cast<double>(sample.size());
  for (const double x : sample) moments.mean += x / n;
  for (const double x : sample) {
    moments.deviation += (x - moments.mean) * (x - moments.mean) / (n - 1);
  }
  moments.deviation = std::sqrt(moments.deviation);
  return moments;
}

// Standard errors of mean and deviation of n independent normal numbers: sigma / sqrt(n) and sigma
// / sqrt(2 n).
inline bool LooksNormal(const std::vector<double>& sample, double mean, double sigma) {
  const Moments seen = MomentsOf(sample);
  const double root = std::sqrt(static_cast<double>(sample.size()));
  return std::fabs(seen.mean - mean) < 5 * sigma / root &&
         std::fabs(seen.deviation - sigma) < 5 * sigma / (std::sqrt(2.0) * root);
}

// The sample with its deviations from `mean` multiplied by `factor`.
inline std::vector<double> Scaled(std::vector<double> sample, double mean, double factor) {
  for (double& x : sample) x = mean + factor * (x - mean);
  return sample;
}

}  // namespace shoal::actor
