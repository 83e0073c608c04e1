// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/mrq/model_loss.h"

#include <algorithm>
#include <cmath>

namespace shoal::learner {
namespace {

constexpr double kLargestLog = 10;  // of a bin: log(1 + |bin|)

std::vector<double> MakeBins() {
  std::vector<double> bins;
  for (int i = 0; i < nn::kRewardBins; ++i) {
    const double x = kLargestLog * (2.0 * i / (nn::kRewardBins - 1) - 1);
    bins.push_back(std::copysign(std::expm1(std::abs(x)), x));
  }
  return bins;
}

// Writes factor * d CE / d logits to `gradient`, and returns the cross-entropy CE.
double CrossEntropy(std::span<const float> logits, const TwoHot& target, double factor,
                    std::span<float> gradient) {
  const double highest = *std::ranges::max_element(logits);
  double sum = 0;
  for (const float logit : logits) sum += std::exp(logit - highest);
  const double log_sum = highest + std::log(sum);
  for (size_t i = 0; i < logits.size(); ++i) {
    gradient[i] = float(factor * std::exp(logits[i] - log_sum));
  }
  const auto low = size_t(target.low), next = std::min(low + 1, logits.size() - 1);
  gradient[low] -= float(factor * (1 - target.weight_of_next));
  gradient[next] -= float(factor * target.weight_of_next);
  return log_sum - (1 - target.weight_of_next) * logits[low] - target.weight_of_next * logits[next];
}

}  // namespace

const std::vector<double>& RewardBins() {
  static const std::vector<double> bins = MakeBins();
  return bins;
}

TwoHot TwoHotOf(double reward) {
  const std::vector<double>& bins = RewardBins();
  if (reward <= bins.front()) return {0, 0};
  if (reward >= bins.back()) return {int(bins.size()) - 1, 0};
  const auto above = std::ranges::upper_bound(bins, reward);
  const double low = *std::prev(above);
  return {int(above - bins.begin()) - 1, (reward - low) / (*above - low)};
}

void AddModelLoss(const ModelStep& step, const ModelLossWeights& weights,
                  const ModelStepGradients& gradients, const ModelRowLosses& losses) {
  const size_t rows = step.present.size(), numbers = step.state.size() / rows;
  const auto count = double(rows);
  for (size_t b = 0; b < rows; ++b) {
    const double present = step.present[b];
    const double slope = 2 * present / (count * double(numbers));
    double squares = 0;
    for (size_t i = b * numbers; i < (b + 1) * numbers; ++i) {
      const double error = double{step.state[i]} - step.target_state[i];
      squares += error * error;
      gradients.state[i] = float(slope * error);
    }
    losses.state[b] += float(present * squares / double(numbers));

    const double cross_entropy =
        CrossEntropy(step.reward_logits.subspan(b * nn::kRewardBins, nn::kRewardBins),
                     TwoHotOf(step.reward[b]), weights.reward * present / count,
                     gradients.reward_logits.subspan(b * nn::kRewardBins, nn::kRewardBins));
    losses.reward[b] += float(present * cross_entropy);

    const double error = double{step.end[b]} - step.terminated[b];
    losses.end[b] += float(present * error * error);
    gradients.end[b] = float(weights.end * 2 * present * error / count);
  }
}

}  // namespace shoal::learner
