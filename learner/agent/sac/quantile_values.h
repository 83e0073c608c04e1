// SPDX-License-Identifier: Apache-2.0
// Critics that compute the distribution of a return, as M quantiles for each action, in place of
// its mean (Eq. 35 of docs/algorithm.md; Kuznetsov et al. 2020, arXiv:2005.04269). sac.quantiles
// sets M.
//
// The operations run on the host (Engine::OnHost), so that a device does not compute such critics.
//
// Dimensions: b rows of this replica, N critics, M quantiles of a critic, D = sac.dropped_quantiles
// for each critic, J = N (M - D) target quantiles. Arrays are row-major.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "common/config/config.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

// Inputs of the targets of b rows.
struct QuantileTargetInputs {
  std::span<const std::span<const float>> next;  // (b, M) for each target critic
  std::span<const float> base;                   // (b) reward and entropy term
  std::span<const float> bootstrap;              // (b) discount^(n-1) (1 - terminated)
};

// y_j = base + bootstrap discount clip(z_j, bounds), j = 1 ... J: z are the J smallest of the N M
// next quantiles. Writes y (b, J) and the means of its rows (b).
void QuantileTargets(const QuantileTargetInputs& inputs, float discount, const ValueBounds& bounds,
                     std::span<float> y, std::span<float> means);

// L = mean_b l_b,  l_b = (1 / (M J)) sum_mj |tau_m - [d < 0]| huber(d),  d = y_j - q_m, tau_m = (m
// - 1/2) / M, huber(d) = d^2 / 2 if |d| <= 1, else |d| - 1/2. Adds l_b to `losses` (b), and writes
// dL/dq (b, M). y: (b, J).
void QuantileLoss(std::span<const float> q, std::span<const float> y, std::span<float> losses,
                  std::span<float> gradient);

// One thread.
class QuantileValues {
 public:
  // Null if each critic has a single value. Borrows the engine.
  static std::unique_ptr<QuantileValues> Make(const Config& config, Engine* engine);
  QuantileValues(const Config& config, Engine* engine);

  // Values of 0 (b), for the base of the targets.
  Array zeros() const { return zeros_; }
  // Computes the targets from the next quantiles of each critic.
  void ComputeTargets(Array base, Array bootstrap, std::span<const Array> next);
  // Computes the loss of the critics, summed over them, and dL/dq_i (b, M) for quantiles q_i.
  // `figures`: of the means of the quantiles, as if these were the values, except for the loss. All
  // are available after the next Gather.
  void CriticLoss(std::span<const Array> q, std::span<const Array> q_gradients,
                  const CriticNumbers& figures);
  // The loss that CriticLoss has computed.
  Number loss() const { return loss_; }

  // The means (b) of the quantiles of each critic.
  std::span<const Array> Means(std::span<const Array> q);
  // Arrays (b) for the gradients of these means.
  std::span<const Array> mean_gradients() const { return mean_gradients_; }
  // Computes the gradients (b, M) of the quantiles from mean_gradients().
  void SpreadGradients(std::span<const Array> q_gradients);

 private:
  Engine* const engine_;
  const float discount_;
  const ValueBounds bounds_;
  const Array zeros_;                          // (b)
  const Array targets_, target_means_;         // (b, J), (b)
  const Array row_losses_;                     // (b)
  std::vector<Array> means_, mean_gradients_;  // (b) for each critic
  const Number loss_;
};

}  // namespace shoal::learner
