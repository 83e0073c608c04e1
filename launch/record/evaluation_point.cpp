#include "launch/record/evaluation_point.h"

#include <fmt/core.h>

namespace shoal::launch {

std::string FormatScore(const EvaluationPoint& point) {
  const std::string score = fmt::format("return {:.3f}", point.mean_return);
  return point.success ? fmt::format("success {:.1f} %, {}", 100 * *point.success, score) : score;
}

}  // namespace shoal::launch
