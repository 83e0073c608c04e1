// SPDX-License-Identifier: Apache-2.0
// The clipped loss of a policy and its values, as in learner/engine/clipped_policy_loss.h (Eq. 22
// and 24 of docs/algorithm.md), with its gradients and figures. Sums and exponentials are in
// double. Three launches compute a loss: PrepareClippedPolicy, ClippedPolicyRows, LogStdGradient.
//
// Dimensions: B rows of the minibatch, A actions.
#pragma once

#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/numbers.h"
#include "learner/device/kernels/reduce.h"

namespace shoal::learner::kernels {

// Numbers that all rows of a minibatch use. advantage = (A - advantage_mean) * advantage_factor.
struct ClippedPolicyConstants {
  double advantage_mean, advantage_factor;
  double log_scale;  // sum_j log sigma_j + log(2 pi) / 2
};

// Computes the constants, and 1 / sigma_j. An advantage is normalised to mean 0 and deviation 1 if
// `normalise` is set and there are at least two rows.
struct PrepareClippedPolicy {
  static constexpr int kThreads = 256;
  struct Shared {
    Reduction<Sums<2>, kThreads> sums;
  };

  int rows = 0, actions = 0;
  bool normalise = true;
  const float* advantage = nullptr;  // (B)
  const float* log_std = nullptr;    // (A)
  double* inverse_sigma = nullptr;   // (A)
  ClippedPolicyConstants* constants = nullptr;

  int blocks() const { return 1; }
  bool operator==(const PrepareClippedPolicy&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    block.Threads([&](int thread) {
      auto sums = Sums<2>::Zero();
      ForAll<kThreads>(thread, rows, [&](int64_t b) { sums[0] += advantage[b]; });
      ForAll<kThreads>(thread, actions, [&](int64_t j) {
        inverse_sigma[j] = std::exp(-double(log_std[j]));
        sums[1] += log_std[j] + kHalfLogTwoPi;
      });
      shared.sums.of_thread[thread] = sums;
    });
    const Sums<2> total = Combine(block, shared.sums);
    const double mean = total[0] / rows;
    block.Threads([&](int thread) {
      auto sums = Sums<2>::Zero();
      ForAll<kThreads>(thread, rows, [&](int64_t b) {
        const double apart = advantage[b] - mean;
        sums[0] += apart * apart;
      });
      shared.sums.of_thread[thread] = sums;
    });
    const double squares = Combine(block, shared.sums)[0];
    block.Threads([&](int thread) {
      if (thread != 0) return;
      const bool as_it_is = !normalise || rows < 2;
      constants->advantage_mean = as_it_is ? 0 : mean;
      constants->advantage_factor =
          as_it_is ? 1 : 1 / (std::sqrt(squares / (rows - 1)) + kDeviationEpsilon);
      constants->log_scale = total[1];
    });
  }

 private:
  static constexpr double kDeviationEpsilon = 1e-8;
};

// Figures of the loss (ClippedPolicyNumbers).
struct ClippedPolicyFigures {
  double *policy = nullptr, *value = nullptr, *total = nullptr, *rounded_total = nullptr;
  double *approx_kl = nullptr, *clip_fraction = nullptr;

  bool operator==(const ClippedPolicyFigures&) const = default;
};

// Computes dL/dmean, dL/dvalue, dL/dlog pi and the figures, with one thread for each row. The last
// block adds the sums of all blocks.
struct ClippedPolicyRows {
  static constexpr int kThreads = 128;
  using Terms = Sums<4>;
  struct Shared {
    Reduction<Terms, kThreads> sums;
  };

  int rows = 0, actions = 0;
  const float *mean = nullptr, *drawn_action = nullptr;                   // (B, A)
  const double* inverse_sigma = nullptr;                                  // (A)
  const float *old_log_prob = nullptr, *advantage = nullptr;              // (B)
  const float *value = nullptr, *old_value = nullptr, *target = nullptr;  // (B)
  const ClippedPolicyConstants* constants = nullptr;
  const double* clip = nullptr;
  double value_clip = 0;  // 0: none
  double value_weight = 0, entropy_weight = 0;
  float *mean_gradient = nullptr, *value_gradient = nullptr;  // (B, A), (B)
  double* log_prob_gradient = nullptr;                        // (B)
  Terms* partials = nullptr;                                  // one for each block
  int32_t* finished = nullptr;                                // counter, 0
  ClippedPolicyFigures figures = {};

  int blocks() const { return BlocksFor(rows); }
  static SHOAL_EVERYWHERE int BlocksFor(int rows) { return int(CeilDivide(rows, kThreads)); }
  bool operator==(const ClippedPolicyRows&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    block.Threads([&](int thread) {
      const int b = block.index() * kThreads + thread;
      shared.sums.of_thread[thread] = b < rows ? ComputeRow(b) : Terms::Zero();
    });
    const Terms own = Combine(block, shared.sums);
    block.Threads([&](int thread) {
      if (thread == 0) partials[block.index()] = own;
    });
    if (!block.FinishesLast(finished, block.count())) return;
    block.Threads([&](int thread) {
      auto sums = Terms::Zero();
      ForAll<kThreads>(thread, block.count(), [&](int64_t i) { sums.Add(partials[i]); });
      shared.sums.of_thread[thread] = sums;
    });
    const Terms total = Combine(block, shared.sums);
    block.Threads([&](int thread) {
      if (thread == 0) SetFigures(total);
    });
  }

 private:
  enum { kPolicy, kValue, kKl, kClipped };

  // Writes the gradients of row b. Returns its terms of the figures.
  SHOAL_KERNEL Terms ComputeRow(int b) const {
    Terms terms;
    const double log_ratio = LogProb(b) - old_log_prob[b];
    const double ratio = std::exp(log_ratio), bound = *clip;
    const double normalised =
        (advantage[b] - constants->advantage_mean) * constants->advantage_factor;
    const double plain = ratio * normalised;
    const double cut = Clamp(ratio, 1 - bound, 1 + bound) * normalised;
    terms[kPolicy] = -Least(plain, cut);
    terms[kKl] = ratio - 1 - log_ratio;
    terms[kClipped] = std::abs(ratio - 1) > bound ? 1 : 0;
    // If the clipped term is smaller, the ratio is beyond its bound and the gradient is 0.
    SetPolicyGradient(b, plain <= cut ? -plain / rows : 0);
    terms[kValue] = ValueError(b);
    return terms;
  }

  SHOAL_KERNEL double LogProb(int b) const {
    const int64_t first = int64_t(b) * actions;
    double sum = -constants->log_scale;
    for (int j = 0; j < actions; ++j) {
      const double z =
          (double(drawn_action[first + j]) - double(mean[first + j])) * inverse_sigma[j];
      sum -= z * z / 2;
    }
    return sum;
  }

  // dlog pi/dmean = z / sigma, with z = (u - mean) / sigma
  SHOAL_KERNEL void SetPolicyGradient(int b, double gradient) const {
    log_prob_gradient[b] = gradient;
    const int64_t first = int64_t(b) * actions;
    for (int j = 0; j < actions; ++j) {
      const double inverse = inverse_sigma[j];
      const double z = (double(drawn_action[first + j]) - double(mean[first + j])) * inverse;
      mean_gradient[first + j] = float(gradient * z * inverse);
    }
  }

  // Writes the gradient of the value. Returns the squared error.
  SHOAL_KERNEL double ValueError(int b) const {
    const double old = old_value[b], moved = double(value[b]) - old;
    const bool clipped = value_clip > 0 && std::abs(moved) > value_clip;
    const double used = clipped ? old + Clamp(moved, -value_clip, value_clip) : double(value[b]);
    const double error = double(target[b]) - used;
    value_gradient[b] = clipped ? 0.f : float(-2 * value_weight * error / rows);
    return error * error;
  }

  SHOAL_KERNEL void SetFigures(const Terms& total) const {
    const double policy = total[kPolicy] / rows, of_value = total[kValue] / rows;
    const double entropy = constants->log_scale + 0.5 * actions;
    const double sum = policy + value_weight * of_value - entropy_weight * entropy;
    *figures.policy = policy;
    *figures.value = of_value;
    *figures.approx_kl = total[kKl] / rows;
    *figures.clip_fraction = total[kClipped] / rows;
    *figures.total = sum;
    *figures.rounded_total = float(sum);
  }
};

// dL/dlog sigma_j = sum_b dL/dlog pi_b (z_bj^2 - 1) - entropy_weight. One block for each action.
struct LogStdGradient {
  static constexpr int kThreads = 128;
  struct Shared {
    Reduction<Sums<1>, kThreads> sum;
  };

  int rows = 0, actions = 0;
  const float *mean = nullptr, *drawn_action = nullptr;  // (B, A)
  const double* inverse_sigma = nullptr;                 // (A)
  const double* log_prob_gradient = nullptr;             // (B)
  double entropy_weight = 0;
  float* gradient = nullptr;  // (A)

  int blocks() const { return actions; }
  bool operator==(const LogStdGradient&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    const int j = block.index();
    block.Threads([&](int thread) {
      auto sum = Sums<1>::Zero();
      ForAll<kThreads>(thread, rows, [&](int64_t b) {
        const int64_t at = b * actions + j;
        const double z = (double(drawn_action[at]) - double(mean[at])) * inverse_sigma[j];
        sum[0] += log_prob_gradient[b] * (z * z - 1);
      });
      shared.sum.of_thread[thread] = sum;
    });
    const double total = Combine(block, shared.sum)[0];
    block.Threads([&](int thread) {
      if (thread == 0) gradient[j] = float(total - entropy_weight);
    });
  }
};

}  // namespace shoal::learner::kernels
