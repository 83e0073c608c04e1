// SPDX-License-Identifier: Apache-2.0
// Chooses the evaluation whose checkpoint is the run's best. Pure.
#pragma once

#include <vector>

#include "launch/run/stop_rule.h"

namespace shoal::launch {

// The best evaluation has the highest return among the evaluations whose success rate equals the
// highest rate within chance (docs/algorithm.md, Eq. 13). An early policy that reached 50 of 50
// goals by chance therefore does not stay the best when later policies get closer to every goal. If
// the task has no success, the evaluation with the highest return is the best. If evaluations are
// equal, the first is chosen.
class BestEvaluation {
 public:
  void OnEvaluation(const EvaluationPoint& point);

  // Null before the first evaluation.
  const EvaluationPoint* best() const;
  // The best evaluation, and the evaluations that may become the best when a later evaluation
  // raises the highest success rate. No other evaluation has both a success rate and a return as
  // high as those of a candidate. The list is short.
  const std::vector<EvaluationPoint>& candidates() const { return candidates_; }
  // Whether the last evaluation is the best.
  bool newest_is_best() const { return newest_is_best_; }

 private:
  std::vector<EvaluationPoint> candidates_;  // in the order of evaluation
  double least_success_ = 0;                 // lowest rate that equals the highest within chance
  bool newest_is_best_ = false;
};

}  // namespace shoal::launch
