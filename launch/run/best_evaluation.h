// Which evaluation a run's best checkpoint is of. Pure.
#pragma once

#include <optional>

#include "launch/run/stop_rule.h"

namespace shoal::launch {

// The highest return among the evaluations whose success is the highest, or less by no more than
// chance (docs/algorithm.md, Eq. 13): an early policy that once reached 50 of 50 goals by luck must
// not stay the best before later ones that come nearer to every goal. Where the task has no success
// of its own, the highest return.
class BestEvaluation {
 public:
  // In the order of evaluation.
  void OnEvaluation(const EvaluationPoint& point);

  const std::optional<EvaluationPoint>& best() const { return best_; }
  // The last one is the best.
  bool newest_is_best() const { return newest_is_best_; }

 private:
  bool IsBest(const EvaluationPoint& point) const;

  std::optional<EvaluationPoint> best_;
  double least_success_ = 0;  // that chance does not tell from the highest
  bool newest_is_best_ = false;
};

}  // namespace shoal::launch
