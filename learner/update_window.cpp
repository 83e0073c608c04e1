// SPDX-License-Identifier: Apache-2.0
#include "learner/update_window.h"

#include <algorithm>

namespace shoal::learner {
void UpdateWindow::Add(const UpdateFigures& figures) {
  ++updates_;
  for (const auto& [figure, value] : figures.entries()) {
    const auto at =
        std::ranges::find(sums_, figure->name, [](const Sum& sum) { return sum.figure->name; });
    if (at == sums_.end()) {
      sums_.push_back({figure, value, 1});
    } else {
      at->sum += value;
      ++at->count;
    }
  }
}

UpdateFigures UpdateWindow::Mean() const {
  UpdateFigures mean;
  for (const Sum& sum : sums_) mean.Set(*sum.figure, sum.sum / sum.count);
  return mean;
}

void AddDataAges(std::span<const uint64_t> weights_update, uint64_t updates,
                 QuantileWindow* window) {
  for (const uint64_t chosen : weights_update) {
    window->Add(static_cast<double>(updates - std::min(chosen, updates)));
  }
}

}  // namespace shoal::learner
