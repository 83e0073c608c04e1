// SPDX-License-Identifier: Apache-2.0
#include "launch/run/best_evaluation.h"

#include <algorithm>
#include <cmath>

namespace shoal::launch {
namespace {

// Eq. 13: one standard error of the difference between two evaluations of a policy with this
// success rate. One success and one failure are added, so that 50 of 50 does not give an error of
// 0.
double ChanceDifference(const EvaluationPoint& point) {
  const auto episodes = static_cast<double>(point.episodes);
  if (episodes == 0) return 0;
  const double rate = (*point.success * episodes + 1) / (episodes + 2);
  return std::sqrt(2 * rate * (1 - rate) / episodes);
}

// 0 for a task without a success: its evaluations are compared by their returns alone.
double SuccessOf(const EvaluationPoint& point) { return point.success.value_or(0); }

// Whether `b` ranks before `a` independently of later evaluations.
bool IsOutdone(const EvaluationPoint& a, const EvaluationPoint& b) {
  return SuccessOf(b) >= SuccessOf(a) && b.mean_return >= a.mean_return;
}

}  // namespace

const EvaluationPoint* BestEvaluation::best() const {
  const auto best = std::ranges::max_element(candidates_, {}, &EvaluationPoint::mean_return);
  return best == candidates_.end() ? nullptr : &*best;
}

void BestEvaluation::OnEvaluation(const EvaluationPoint& point) {
  if (point.success) {
    least_success_ = std::max(least_success_, *point.success - ChanceDifference(point));
  }
  std::erase_if(candidates_,
                [&](const EvaluationPoint& other) { return SuccessOf(other) < least_success_; });
  newest_is_best_ = false;
  const auto outdoes = [&](const EvaluationPoint& other) { return IsOutdone(point, other); };
  if (SuccessOf(point) < least_success_ || std::ranges::any_of(candidates_, outdoes)) return;
  std::erase_if(candidates_, [&](const EvaluationPoint& other) { return IsOutdone(other, point); });
  candidates_.push_back(point);
  newest_is_best_ = best() == &candidates_.back();
}

}  // namespace shoal::launch
