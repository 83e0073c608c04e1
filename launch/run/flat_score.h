// SPDX-License-Identifier: Apache-2.0
// Detects a run whose evaluations do not improve: the run works but does not learn. Pure.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "launch/run/stop_rule.h"

namespace shoal::launch {

// Examines the newest kWindow evaluations. A value has risen if its mean over the newer half
// exceeds its mean over the older half by more than two standard errors of the difference. A run is
// flat if neither return nor success (if the task has success) has risen, and the newest success is
// below the target.
class FlatScore {
 public:
  // Call in the order of evaluation. `target`: StopRule::target(). Returns one line with the values
  // when the run is flat for the first time, and nothing later.
  std::optional<std::string> OnEvaluation(const EvaluationPoint& point, double target);

  static constexpr size_t kWindow = 10;

 private:
  std::deque<EvaluationPoint> newest_;  // at most kWindow
  bool said_ = false;
};

}  // namespace shoal::launch
