// SPDX-License-Identifier: Apache-2.0
// Actions of a Gaussian squashed by tanh, their log-probabilities and the gradients of both (Eq. 4
// of docs/algorithm.md): operations of the CPU's engine.
//
//   u = mean + sigma * eps,   sigma = exp(log_std),   eps ~ N(0, 1)
//   a = tanh(u)
//   log pi = sum_j [ -eps_j^2 / 2 - log_std_j - ln(2 pi) / 2 - 2 (ln 2 - u_j - softplus(-2 u_j)) ]
//
// The last term is ln(1 - a_j^2), written so that it stays exact where a_j rounds to 1.
// Source: Haarnoja et al. 2018, arXiv:1801.01290, appendix C.
// Dimensions: B batch, A actions. Arrays are (B, A), except log_prob (B).
#pragma once

#include <span>

namespace shoal::learner {

// A sample, and the values that its gradients need.
struct SquashedValues {
  std::span<float> scaled_noise, action;  // sigma eps, a
  std::span<float> log_prob;              // (B)
};

// Computes a sample from given noise eps.
void SquashGaussian(std::span<const float> mean, std::span<const float> log_std,
                    std::span<const float> noise, const SquashedValues& sample);

//   dL/du = dL/da (1 - a^2) + dL/dlogpi * 2 a
//   dL/dmean = dL/du,   dL/dlog_std = dL/du sigma eps - dL/dlogpi
//
// log_prob_gradient is the same for every sample of the batch.
void SquashedGaussianBackward(const SquashedValues& sample, std::span<const float> action_gradient,
                              float log_prob_gradient, std::span<float> mean_gradient,
                              std::span<float> log_std_gradient);

// -mean log pi.
float SquashedEntropy(std::span<const float> log_prob);

}  // namespace shoal::learner
