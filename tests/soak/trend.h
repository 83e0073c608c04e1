// SPDX-License-Identifier: Apache-2.0
// The trend of a quantity that is measured repeatedly.
#pragma once

#include <vector>

namespace shoal::soak {

class Trend {
 public:
  void Add(double seconds, double value);

  int samples() const { return static_cast<int>(values_.size()); }
  double Mean() const;
  // Slope of the least-squares line, in units per second; 0 if there are fewer than two samples.
  double Slope() const;
  // The slope over ten minutes, in percent of the mean, or in percent of 1 if the mean is below 1.
  // For example, an empty queue that grows by one element in ten minutes grows by 100 %.
  double PercentPerTenMinutes() const;
  // Standard error of PercentPerTenMinutes, from the scatter around the line.
  double PercentError() const;

 private:
  double Scale() const;   // PercentPerTenMinutes / Slope
  double Spread() const;  // sum of squared distances of the times from their mean

  std::vector<double> seconds_, values_;
};

}  // namespace shoal::soak
