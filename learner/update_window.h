// SPDX-License-Identifier: Apache-2.0
// The updates of one report interval: means of the updates' metrics (UpdateFigures), and the age of
// the data.
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
  // Mean of each metric over the updates in the window that have this metric. The order is that of
  // the first appearance. If no update has a metric, the metric is absent.
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

// Adds the age of each row of a batch: the number of updates since the weights that chose the
// action. A random action counts as chosen by the untrained policy, update 0. `weights_update` (B):
// array of the batch; `updates`: number of updates so far. If the weights are newer than `updates`,
// because the learner was restarted from an earlier checkpoint, the age is 0.
void AddDataAges(std::span<const uint64_t> weights_update, uint64_t updates,
                 QuantileWindow* window);

}  // namespace shoal::learner
