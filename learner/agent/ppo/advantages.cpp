// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/ppo/advantages.h"

#include "common/base/check.h"

namespace shoal::learner {

void Advantages(const AdvantageInputs& inputs, std::span<float> advantage,
                std::span<float> target) {
  const size_t rows = inputs.reward.size();
  CHECK(advantage.size() == rows && target.size() == rows) << rows;
  double next_advantage = 0;
  for (size_t t = rows; t-- > 0;) {
    const double delta =
        inputs.reward[t] +
        inputs.discount * double{inputs.bootstrap[t]} * double{inputs.next_value[t]} -
        double{inputs.value[t]};
    next_advantage =
        delta + inputs.discount * inputs.lambda * double{inputs.continues[t]} * next_advantage;
    advantage[t] = static_cast<float>(next_advantage);
    target[t] = advantage[t] + inputs.value[t];
  }
}

double ExplainedVariance(std::span<const float> value, std::span<const float> target) {
  double target_sum = 0, target_squares = 0, error_sum = 0, error_squares = 0;
  for (size_t i = 0; i < target.size(); ++i) {
    const double y = target[i], error = y - double{value[i]};
    target_sum += y;
    target_squares += y * y;
    error_sum += error;
    error_squares += error * error;
  }
  const auto n = static_cast<double>(target.size());
  const double variance = target_squares / n - target_sum * target_sum / (n * n);
  if (variance <= 0) return 0;
  return 1 - (error_squares / n - error_sum * error_sum / (n * n)) / variance;
}

}  // namespace shoal::learner
