// SPDX-License-Identifier: Apache-2.0
#include "common/wire/quantile_window.h"

#include <algorithm>
#include <cmath>

namespace shoal {

void QuantileWindow::Add(double value) {
  if (++skipped_ < stride_) return;
  skipped_ = 0;
  if (kept_.size() == kMost) {
    for (size_t i = 0; 2 * i + 1 < kMost; ++i) kept_[i] = kept_[2 * i + 1];
    kept_.resize(kMost / 2);
    stride_ *= 2;
  }
  kept_.push_back(value);
}

std::optional<Quantiles> QuantileWindow::Take() {
  if (kept_.empty()) return std::nullopt;
  std::ranges::sort(kept_);
  const auto at = [&](double share) {
    const double rank = std::ceil(share * static_cast<double>(kept_.size()));
    return kept_[static_cast<size_t>(std::max(rank, 1.0)) - 1];
  };
  const Quantiles result{at(0.5), at(0.9), at(0.99)};
  *this = QuantileWindow();
  return result;
}

}  // namespace shoal
