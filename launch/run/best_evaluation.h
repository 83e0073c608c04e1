// SPDX-License-Identifier: Apache-2.0
// Which evaluation a run's best checkpoint is of. Pure.
#pragma once

#include <vector>

#include "launch/run/stop_rule.h"

namespace shoal::launch {

// The highest return among the evaluations whose success is the highest, or less by no more than
// chance (docs/algorithm.md, Eq. 13): an early policy that once reached 50 of 50 goals by luck must
// not stay the best before later ones that come nearer to every goal. Where the task has no success
// of its own, the highest return. Does not depend on the order of evaluations but where two are
// equal: the first one counts.
class BestEvaluation {
 public:
  void OnEvaluation(const EvaluationPoint& point);

  // Null before the first evaluation.
  const EvaluationPoint* best() const;
  // Those that are the best or may become it when a later evaluation raises what counts as success:
  // no other has both as much success and as high a return. Few.
  const std::vector<EvaluationPoint>& candidates() const { return candidates_; }
  // The last one is the best.
  bool newest_is_best() const { return newest_is_best_; }

 private:
  std::vector<EvaluationPoint> candidates_;  // in the order of evaluation
  double least_success_ = 0;                 // that chance does not tell from the highest
  bool newest_is_best_ = false;
};

}  // namespace shoal::launch
