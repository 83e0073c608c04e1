// SPDX-License-Identifier: Apache-2.0
// Targets and losses of the CPU's engine, with the gradients of losses with respect to the
// networks' outputs. Sums are computed in double. Equations are numbered in docs/algorithm.md.
// Dimensions: B batch, A actions, L labels; arrays are (B) f32 unless said otherwise. Sources:
// Haarnoja et al. 2018, arXiv:1812.05905; Fujimoto et al. 2018, arXiv:1802.09477.
#pragma once

#include <limits>
#include <span>

namespace shoal::learner {

// Bounds of values (Eq. 20). An empty bound does not limit.
struct ValueBounds {
  float low = -std::numeric_limits<float>::infinity();
  float high = std::numeric_limits<float>::infinity();
};

// Inputs of the targets of one batch.
struct TargetInputs {
  const float* reward;
  const float* bootstrap;                // discount^(n-1) (1 - terminated)
  std::span<const float* const> next_q;  // one or more target critics at (s', a')
  const float* next_log_prob = nullptr;  // log pi(a' | s'); null: no entropy term
};

struct TargetRates {
  float reward_scale, discount;
  float temperature = 0;  // weight of the entropy term
  ValueBounds bounds = {};
};

// Eq. 5 and 18:  y = reward_scale r + bootstrap discount (min_i q'_i - temperature log pi'), with
// the minimum clipped to the bounds (Eq. 20).
void TdTargets(int batch, const TargetInputs& inputs, const TargetRates& rates, float* y);

// Eq. 15:  replaces each group of `copies` consecutive targets by the mean of its first `shifts`
// targets, which have different shifts; 0 = of all targets. `copies` divides `batch`.
void AverageCopies(int batch, int copies, int shifts, float* y);

// Eq. 6:  L = sum_i mean_b (q_i - y)^2;   dL/dq_i = 2 (q_i - y) / B
// Eq. 34: the squares are multiplied by weights, or replaced by Huber's function of the errors e:
//   h(e) = e^2 if |e| <= 1, else 2 |e| - 1;   dh/de = 2 clip(e, -1, 1)
struct RowLoss {
  const float* weights = nullptr;  // null: 1
  bool huber = false;
};
struct CriticLoss {
  float loss, q_mean, target_mean;  // q_mean over all critics
};
CriticLoss CriticLossForward(int batch, std::span<const float* const> q, const float* y,
                             const RowLoss& rows = {});
void CriticLossBackward(int batch, const float* q, const float* y, float* q_gradient,
                        const RowLoss& rows = {});
// max_i |q_i - y| (B).
void CriticErrors(int batch, std::span<const float* const> q, const float* y, float* errors);

// Mean, standard deviation, smallest and largest of an array that is not empty.
struct Summary {
  double mean = 0, deviation = 0, least = 0, most = 0;
};
Summary Summarise(std::span<const float> values);

// The value of an action in the actor's loss: the smallest of the Q functions (Eq. 7), or their
// mean (Eq. 30).
enum class ActorValue { kMin, kMean };

// Eq. 7 and 30:  L = mean_b (temperature log pi - v),  v = min_i q_i or mean_i q_i
//   dL/dlogpi = temperature / B
//   kMin:  dL/dq_i = -1 / B for the smallest q_i (the first one on a tie), else 0
//   kMean: dL/dq_i = -1 / (N B) for N Q functions
float ActorLossForward(int batch, const float* log_prob, std::span<const float* const> q,
                       ActorValue value, float temperature);
void ActorLossBackward(int batch, std::span<const float* const> q, ActorValue value,
                       std::span<float* const> q_gradients);

// Eq. 19 and 32:  L = -mean_b min_i q_i + mean_penalty mean_ba m^2;   dL/dq_i = -1 / B for the
// smallest (the first one on a tie), else 0. mean: m (B, A), the policy's outputs before tanh.
float DeterministicActorLoss(int batch, std::span<const float* const> q,
                             std::span<const float> mean, double mean_penalty,
                             std::span<float* const> q_gradients);

// Eq. 8:  L = temperature (entropy - target_entropy) with entropy = -mean_b log pi held fixed;
//   dL/dlog temperature = L
float TemperatureLoss(float temperature, float entropy, float target_entropy);

// Eq. 27:  L = weight / (B L) sum_bl (y - label)^2;   dL/dy = 2 weight (y - label) / (B L). y,
// labels (B, L). Returns the sum of (y - label)^2.
double LabelLoss(std::span<const float> y, std::span<const float> labels, float weight,
                 std::span<float> gradient);

// The share of numbers with an absolute value above 0.99.
double SaturatedShare(std::span<const float> actions);

}  // namespace shoal::learner
