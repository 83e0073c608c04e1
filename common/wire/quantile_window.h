// SPDX-License-Identifier: Apache-2.0
// Quantiles of the values of one report interval, in bounded memory.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace shoal {

struct Quantiles {
  double p50 = 0, p90 = 0, p99 = 0;
};

// Keeps all values while there are at most kMost of them. If there are more, keeps every second
// value, then every fourth, and so on, evenly over the interval. Only one thread may use an object.
class QuantileWindow {
 public:
  static constexpr size_t kMost = 4096;

  void Add(double value);
  // Nearest-rank quantiles of the values that were added since the last Take; empty if no value was
  // added.
  std::optional<Quantiles> Take();

 private:
  std::vector<double> kept_;
  size_t stride_ = 1;   // one of this many values is kept
  size_t skipped_ = 0;  // number of values since the last kept value
};

}  // namespace shoal
