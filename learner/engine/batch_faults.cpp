// SPDX-License-Identifier: Apache-2.0
#include "learner/engine/batch_faults.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shoal::learner {
namespace {

bool AreFinite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

}  // namespace

bool AllFinite(const BatchView& batch) {
  return AreFinite(std::span<const float>(batch.obs_vector)) &&
         AreFinite(std::span<const float>(batch.next_obs_vector)) &&
         AreFinite(std::span<const float>(batch.obs_privileged)) &&
         AreFinite(std::span<const float>(batch.next_obs_privileged)) &&
         AreFinite(std::span<const float>(batch.action)) &&
         AreFinite(std::span<const float>(batch.reward)) &&
         AreFinite(std::span<const float>(batch.bootstrap)) &&
         AreFinite(std::span<const float>(batch.drawn_action)) &&
         AreFinite(std::span<const float>(batch.log_prob)) &&
         std::ranges::all_of(batch.steps, [](const StepView& step) {
           return AreFinite(step.next_vector) && AreFinite(step.action) && AreFinite(step.reward);
         });
}

bool FitsMoments(double gradient_squares) {
  return gradient_squares < std::numeric_limits<float>::max();
}

}  // namespace shoal::learner
