// The updates of one report interval: means of their figures and the age of the data they used.
#pragma once

#include <cstdint>
#include <span>

#include "common/wire/quantile_window.h"
#include "learner/sac_agent.h"

namespace shoal::learner {

class UpdateWindow {
 public:
  void Add(const UpdateStats& stats);
  // Empties the window; the next interval begins.
  void Clear() { *this = UpdateWindow(); }

  int updates() const { return updates_; }
  // Mean over the window's updates; all zero when it is empty.
  UpdateStats Mean() const;

 private:
  int updates_ = 0;
  UpdateStats sum_;
};

// Adds the age of a batch's data: how many updates ago the weights that chose each action were
// made. A random action counts as chosen by the untrained policy, update 0. `weights_update` (B) of
// the batch; `updates`: done now. Values beyond it (of a learner that was ahead before it
// restarted) count as 0.
void AddDataAges(std::span<const uint64_t> weights_update, uint64_t updates,
                 QuantileWindow* window);

}  // namespace shoal::learner
