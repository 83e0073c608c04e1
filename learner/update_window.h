// SPDX-License-Identifier: Apache-2.0
// The updates of one report interval: means of their figures, and the age of their data.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/wire/quantile_window.h"
#include "learner/agent/update_figures.h"

namespace shoal::learner {

class UpdateWindow {
 public:
  void Add(const UpdateFigures& figures);
  // Empties the window; the next interval begins.
  void Clear() { *this = UpdateWindow(); }

  int updates() const { return updates_; }
  // Mean of each figure over the window's updates that have the figure, in the order of first
  // appearance. A figure that no update has is absent.
  UpdateFigures Mean() const;

 private:
  struct Sum {
    const Figure* figure;
    double sum;
    int count;
  };

  int updates_ = 0;
  std::vector<Sum> sums_;
};

// Adds the age of a batch's data: how many updates ago the weights that chose each action were
// made. A random action counts as chosen by the untrained policy, update 0. `weights_update` (B):
// array of the batch; `updates`: updates done so far. Weights newer than `updates` (from a learner
// that was ahead before it restarted) give the age 0.
void AddDataAges(std::span<const uint64_t> weights_update, uint64_t updates,
                 QuantileWindow* window);

}  // namespace shoal::learner
