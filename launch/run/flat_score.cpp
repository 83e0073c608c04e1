// SPDX-License-Identifier: Apache-2.0
#include "launch/run/flat_score.h"

#include <fmt/core.h>

#include <cmath>

namespace shoal::launch {
namespace {

constexpr size_t kHalf = FlatScore::kWindow / 2;

struct Half {
  double mean = 0, variance_of_mean = 0;
};

// Mean of a figure over kHalf evaluations, beginning with number `from`.
template <class Figure>
Half HalfOf(const std::deque<EvaluationPoint>& points, size_t from, const Figure& figure) {
  Half half;
  for (size_t i = from; i < from + kHalf; ++i) half.mean += figure(points[i]) / kHalf;
  double squares = 0;
  for (size_t i = from; i < from + kHalf; ++i) {
    squares += std::pow(figure(points[i]) - half.mean, 2);
  }
  half.variance_of_mean = squares / (kHalf - 1) / kHalf;
  return half;
}

struct Movement {
  double before = 0, after = 0;
  bool rose = false;
};

template <class Figure>
Movement MovementOf(const std::deque<EvaluationPoint>& points, const Figure& figure) {
  const Half older = HalfOf(points, 0, figure), newer = HalfOf(points, kHalf, figure);
  const double error = std::sqrt(older.variance_of_mean + newer.variance_of_mean);
  return {older.mean, newer.mean, newer.mean - older.mean > 2 * error};
}

double Success(const EvaluationPoint& point) { return point.success.value_or(0); }
double Return(const EvaluationPoint& point) { return point.mean_return; }

}  // namespace

std::optional<std::string> FlatScore::OnEvaluation(const EvaluationPoint& point, double target) {
  newest_.push_back(point);
  if (newest_.size() > kWindow) newest_.pop_front();
  if (said_ || newest_.size() < kWindow) return std::nullopt;
  if (point.success && *point.success >= target) return std::nullopt;
  const Movement success = MovementOf(newest_, Success), returns = MovementOf(newest_, Return);
  if (success.rose || returns.rose) return std::nullopt;
  said_ = true;
  std::string line = fmt::format(
      "warning: no progress over the last {} evaluations ({} to {} env steps): return {:.3f} in "
      "the "
      "first half, {:.3f} in the second",
      kWindow, newest_.front().env_steps, point.env_steps, returns.before, returns.after);
  if (point.success) {
    line +=
        fmt::format(", success {:.1f} % and {:.1f} %", 100 * success.before, 100 * success.after);
  }
  return line;
}

}  // namespace shoal::launch
