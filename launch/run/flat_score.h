// SPDX-License-Identifier: Apache-2.0
// Detects a run whose evaluations do not improve: the run works but does not learn. Pure.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "launch/run/stop_rule.h"

namespace shoal::launch {

// Looks at the newest kWindow evaluations. A figure has risen when its mean over the newer half
// exceeds that over the older half by more than two standard errors of their difference. A run is
// flat if neither its return nor its success (if the task has one) has risen, and its newest
// success is below the target.
class FlatScore {
 public:
  // Call in the order of evaluation. `target`: StopRule::target(). Returns one line with the
  // figures the first time that the run is flat, and nothing later.
  std::optional<std::string> OnEvaluation(const EvaluationPoint& point, double target);

  static constexpr size_t kWindow = 10;

 private:
  std::deque<EvaluationPoint> newest_;  // at most kWindow
  bool said_ = false;
};

}  // namespace shoal::launch
