// SPDX-License-Identifier: Apache-2.0
#include "launch/record/first_reached.h"

#include "common/base/check.h"

namespace shoal::launch {
namespace {

// Rates times counts are whole numbers up to rounding errors; this tolerance is far below one
// episode.
constexpr double kRounding = 1e-6;

}  // namespace

bool ReachTogether(std::span<const EvaluatedSuccess> evaluations, double target) {
  double successes = 0, episodes = 0;
  for (const EvaluatedSuccess& evaluation : evaluations) {
    if (!evaluation.rate) return false;
    episodes += static_cast<double>(evaluation.episodes);
    successes += *evaluation.rate * static_cast<double>(evaluation.episodes);
  }
  return episodes > 0 && successes >= target * episodes - kRounding;
}

std::optional<size_t> FirstReached(std::span<const EvaluatedSuccess> evaluations, double target,
                                   size_t in_a_row) {
  CHECK(in_a_row >= 1);
  for (size_t first = 0; first + in_a_row <= evaluations.size(); ++first) {
    if (ReachTogether(evaluations.subspan(first, in_a_row), target)) return first;
  }
  return std::nullopt;
}

}  // namespace shoal::launch
