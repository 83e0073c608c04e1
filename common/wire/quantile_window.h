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

// Keeps all values up to kMost. Beyond kMost values, keeps every second value, then every fourth,
// and so on, evenly over the interval. One thread.
class QuantileWindow {
 public:
  static constexpr size_t kMost = 4096;

  void Add(double value);
  // Nearest-rank quantiles of the values added since the last Take; empty if there are none.
  std::optional<Quantiles> Take();

 private:
  std::vector<double> kept_;
  size_t stride_ = 1;   // one of this many values is kept
  size_t skipped_ = 0;  // values since the last kept one
};

}  // namespace shoal
