// SPDX-License-Identifier: Apache-2.0
// The clipped loss of a minibatch of policy and values, and its gradients with respect to the
// networks' outputs: an operation of the CPU's engine. Equations are numbered in docs/algorithm.md.
//
//   log pi(u|s) = sum_j -((u_j - mean_j) / sigma_j)^2 / 2 - log sigma_j - log(2 pi) / 2     Eq. 22
//   rho = exp(log pi - log pi_old)
//   L = -mean_b min(rho A, clip(rho, 1 - c, 1 + c) A)                                       Eq. 24
//     + w_v mean_b (R - V)^2 - w_e H,          H = sum_j log sigma_j + log(2 pi e) / 2
//
// If there is a value clip c_v, V is V_old + clip(V - V_old, -c_v, c_v). If requested, A is first
// normalised over the minibatch to mean 0 and deviation 1; a minibatch of one row is not
// normalised. A clipped term has gradient 0.
// Source: Schulman et al. 2017, arXiv:1707.06347; computed as in ppo.py of Stable-Baselines3.
// Dimensions: B minibatch, A actions.
#pragma once

#include <span>

namespace shoal::learner {

struct ClippedPolicyInputs {
  int batch = 0, action_size = 0;       // B, A
  std::span<const float> mean;          // (B, A)
  std::span<const float> log_std;       // (A)
  std::span<const float> value;         // (B)
  std::span<const float> drawn_action;  // (B, A): u
  std::span<const float> old_log_prob;  // (B)
  std::span<const float> old_value;     // (B): before the update
  std::span<const float> advantage;     // (B)
  std::span<const float> target;        // (B): R
  double clip = 0.2, value_clip = 0;    // c; c_v, 0 = none
  double value_weight = 0.5, entropy_weight = 0;
  bool normalise_advantages = true;
};

struct ClippedPolicyLoss {
  double policy = 0, value = 0, entropy = 0;  // without their weights
  double approx_kl = 0;                       // mean of rho - 1 - log rho
  double clip_fraction = 0;                   // share of |rho - 1| > clip
  double total = 0;
};

// Gradients (B, A), (A), (B); overwritten.
struct ClippedPolicyGradients {
  std::span<float> mean, log_std, value;
};

ClippedPolicyLoss ClippedPolicyLossAndGradients(const ClippedPolicyInputs& inputs,
                                                const ClippedPolicyGradients& gradients);

// Mean deviation and entropy of a Gaussian with log deviations (A).
struct GaussianSpread {
  double deviation = 0, entropy = 0;
};
GaussianSpread SpreadOf(std::span<const float> log_std);

}  // namespace shoal::learner
