#include "launch/run/best_evaluation.h"

#include <algorithm>
#include <cmath>

namespace shoal::launch {
namespace {

// Eq. 13: one standard error of the difference between two evaluations of a policy that has the
// success of this one. One success and one failure are added, so that 50 of 50 is not taken for
// certain.
double ChanceDifference(const EvaluationPoint& point) {
  const auto episodes = static_cast<double>(point.episodes);
  if (episodes == 0) return 0;
  const double rate = (*point.success * episodes + 1) / (episodes + 2);
  return std::sqrt(2 * rate * (1 - rate) / episodes);
}

}  // namespace

bool BestEvaluation::IsBest(const EvaluationPoint& point) const {
  if (!best_ || !point.success) return !best_ || point.mean_return > best_->mean_return;
  if (*point.success < least_success_) return false;
  return *best_->success < least_success_ || point.mean_return > best_->mean_return;
}

void BestEvaluation::OnEvaluation(const EvaluationPoint& point) {
  if (point.success) {
    least_success_ = std::max(least_success_, *point.success - ChanceDifference(point));
  }
  newest_is_best_ = IsBest(point);
  if (newest_is_best_) best_ = point;
}

}  // namespace shoal::launch
