// SPDX-License-Identifier: Apache-2.0
// Actions of a Gaussian squashed by tanh, their log-probabilities and the gradients of both (Eq. 4
// of docs/algorithm.md).
//
//   u = mean + sigma * eps,   sigma = exp(log_std),   eps ~ N(0, 1)
//   a = tanh(u)
//   log pi = sum_j [ -eps_j^2 / 2 - log_std_j - ln(2 pi) / 2 - 2 (ln 2 - u_j - softplus(-2 u_j)) ]
//
// The last term is ln(1 - a_j^2), written so that it stays exact where a_j rounds to 1.
// Source: Haarnoja et al. 2018, arXiv:1801.01290, appendix C.
// Dimensions: B batch, A actions. Arrays (B, A) but log_prob (B).
#pragma once

#include <vector>

#include "common/base/random.h"

namespace shoal::learner {

class SquashedGaussian {
 public:
  SquashedGaussian(int batch, int action_size);

  // Draws B * A normals in order and keeps what Backward needs.
  void Sample(const float* mean, const float* log_std, Random* random);
  // The same with given noise (B, A).
  void Transform(const float* mean, const float* log_std, const float* noise);

  const float* action() const { return action_.data(); }
  const float* log_prob() const { return log_prob_.data(); }

  //   dL/du = dL/da (1 - a^2) + dL/dlogpi * 2 a
  //   dL/dmean = dL/du,   dL/dlog_std = dL/du sigma eps - dL/dlogpi
  //
  // log_prob_gradient is the same for every sample of the batch.
  void Backward(const float* action_gradient, float log_prob_gradient, float* mean_gradient,
                float* log_std_gradient) const;

  // -mean log pi.
  float Entropy() const;
  // Share of components with |a| > 0.99.
  float Saturation() const;

 private:
  int batch_, action_size_;
  std::vector<float> noise_, scaled_noise_, action_;  // (B, A): eps, sigma eps, a
  std::vector<float> log_prob_;                       // (B)
};

}  // namespace shoal::learner
