// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/critic_figures.h"

#include <cmath>
#include <vector>

#include "learner/agent/losses.h"
#include "learner/agent/sample_figures.h"

namespace shoal::learner {

void PostCriticValues(nn::Replica* replica, std::span<const float* const> q,
                      std::span<const float> y) {
  std::vector<std::span<const float>> own;
  for (const float* values : q) own.emplace_back(values, y.size());
  own.push_back(y);
  replica->Post(own, {});
}

float SetCriticFigures(const nn::Replica& replica, double gradient_squares,
                       UpdateFigures* figures) {
  const std::vector<std::vector<float>> whole = replica.Posted().arrays;
  const std::vector<float>& whole_y = whole.back();
  std::vector<const float*> whole_q;
  for (size_t i = 0; i + 1 < whole.size(); ++i) whole_q.push_back(whole[i].data());
  const auto batch = int(whole_y.size());
  const CriticLoss loss = CriticLossForward(batch, whole_q, whole_y.data());
  figures->Set(kCriticLoss, loss.loss);
  figures->Set(kQMean, loss.q_mean);
  figures->Set(kTargetMean, loss.target_mean);
  figures->Set(kCriticGradNorm, std::sqrt(gradient_squares));
  AddValueFigures(batch, whole_q, figures);
  return loss.loss;
}

}  // namespace shoal::learner
