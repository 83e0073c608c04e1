// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/critic_rows.h"

#include <algorithm>
#include <cmath>

#include "common/config/priorities.h"
#include "learner/engine/losses.h"

namespace shoal::learner {

std::vector<float> ImportanceWeights(std::span<const float> probabilities, double exponent) {
  const double least = std::ranges::min(probabilities);
  std::vector<float> weights;
  weights.reserve(probabilities.size());
  for (const float probability : probabilities) {
    weights.push_back(float(std::pow(least / probability, exponent)));
  }
  return weights;
}

CriticRows CriticRowsMaker::Of(const BatchView& drawn, FigureSheet* figures) {
  if (!HasPriorities(replay_)) return {};
  CriticRows rows{.weights = {}, .huber = replay_.priorities == "lap", .returns_errors = true};
  if (!HasImportanceWeights(replay_)) return rows;
  const std::vector<float> weights =
      ImportanceWeights(drawn.probability, replay_.priority_correction.At(drawn.stored_steps));
  weights_.assign(weights.begin(), weights.end());
  rows.weights = engine_->TakeRows(weights_);
  figures->SetValue(kImportanceWeight, Summarise(weights_).mean);
  return rows;
}

}  // namespace shoal::learner
