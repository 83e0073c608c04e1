// SPDX-License-Identifier: Apache-2.0
// Chooses the evaluation whose checkpoint is the run's best. Pure.
#pragma once

#include <vector>

#include "launch/run/stop_rule.h"

namespace shoal::launch {

// The best evaluation has the highest return among those whose success rate equals the highest rate
// within chance (docs/algorithm.md, Eq. 13). So an early policy that once reached 50 of 50 goals by
// luck does not stay the best when later policies get closer to every goal. If the task has no
// success of its own, the evaluation with the highest return is the best. The order of evaluations
// matters only for equal ones: the first is chosen.
class BestEvaluation {
 public:
  void OnEvaluation(const EvaluationPoint& point);

  // Null before the first evaluation.
  const EvaluationPoint* best() const;
  // The evaluations that are the best, or may become the best when a later evaluation raises the
  // highest success rate: no other evaluation has both as high a success rate and as high a return.
  // The list is short.
  const std::vector<EvaluationPoint>& candidates() const { return candidates_; }
  // Whether the last evaluation is the best.
  bool newest_is_best() const { return newest_is_best_; }

 private:
  std::vector<EvaluationPoint> candidates_;  // in the order of evaluation
  double least_success_ = 0;                 // lowest rate within chance of the highest one
  bool newest_is_best_ = false;
};

}  // namespace shoal::launch
