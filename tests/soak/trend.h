// SPDX-License-Identifier: Apache-2.0
// The trend of a figure that is sampled repeatedly.
#pragma once

#include <vector>

namespace shoal::soak {

class Trend {
 public:
  void Add(double seconds, double value);

  int samples() const { return static_cast<int>(values_.size()); }
  double Mean() const;
  // Slope of the least-squares line, in units per second. 0 with fewer than two samples.
  double Slope() const;
  // The slope over ten minutes, in percent of the mean, or of 1 if the mean is below 1: an empty
  // queue that grows by one in ten minutes grows by 100 %.
  double PercentPerTenMinutes() const;
  // One standard error of the percentage, from the scatter around the line.
  double PercentError() const;

 private:
  double Scale() const;   // from Slope to percent per ten minutes
  double Spread() const;  // sum of squared distances of the times from their mean

  std::vector<double> seconds_, values_;
};

}  // namespace shoal::soak
