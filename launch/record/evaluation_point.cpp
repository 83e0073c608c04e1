// SPDX-License-Identifier: Apache-2.0
#include "launch/record/evaluation_point.h"

#include <fmt/core.h>

namespace shoal::launch {

namespace {

std::string FaultyText(const EvaluationPoint& point) {
  return point.faulty_episodes > 0 ? fmt::format(", {} faulty episodes", point.faulty_episodes)
                                   : "";
}

}  // namespace

std::string FormatScore(const EvaluationPoint& point) {
  std::string mean = fmt::format("return {:.3f}", point.mean_return);
  if (point.return_std) mean += fmt::format(" +- {:.3f}", *point.return_std);
  if (point.success) {
    const std::string of = point.episodes > 0 ? fmt::format(" of {} episodes", point.episodes) : "";
    return fmt::format("success {:.1f} %{}, {}{}", 100 * *point.success, of, mean,
                       FaultyText(point));
  }
  if (point.mean_length > 0) mean += fmt::format(", length {:.1f}", point.mean_length);
  if (point.episodes > 0) mean += fmt::format(", {} episodes", point.episodes);
  return mean + FaultyText(point);
}

std::string FormatWholeScore(const EvaluationPoint& point) {
  std::string score = FormatScore(point);
  if (point.success && point.mean_length > 0) {
    score += fmt::format(", length {:.1f}", point.mean_length);
  }
  if (point.final_distance)
    score += fmt::format(", final distance {:.3f} m", *point.final_distance);
  return score;
}

}  // namespace shoal::launch
