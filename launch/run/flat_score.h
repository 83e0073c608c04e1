// SPDX-License-Identifier: Apache-2.0
// A run whose evaluations do not get better: "runs but does not learn", seen from outside. Pure.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "launch/run/stop_rule.h"

namespace shoal::launch {

// Looks at the newest kWindow evaluations. A figure has risen when its mean over the newer half
// exceeds that over the older half by more than two standard errors of their difference. Flat is a
// run whose return has not risen, nor its success where the task has one, and whose newest success
// is below the target.
class FlatScore {
 public:
  // In the order of evaluation; `target` as StopRule::target(). One line with the figures the first
  // time that the run is flat, then never again.
  std::optional<std::string> OnEvaluation(const EvaluationPoint& point, double target);

  static constexpr size_t kWindow = 10;

 private:
  std::deque<EvaluationPoint> newest_;  // at most kWindow
  bool said_ = false;
};

}  // namespace shoal::launch
