// The updates of one report interval: means of their figures and the age of the policies that chose
// the last batch's actions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

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

// How many updates ago the weights that chose an action were made; a random action counts as chosen
// by the untrained policy, update 0.
struct PolicyLag {
  double p50 = 0, p95 = 0;
};

// `weights_update` (B) of a batch; `updates`: done now. Values beyond it (of a learner that was
// ahead before it restarted) count as 0. Percentiles are nearest-rank.
PolicyLag ComputePolicyLag(std::span<const uint64_t> weights_update, uint64_t updates);

}  // namespace shoal::learner
