// SPDX-License-Identifier: Apache-2.0
// Outputs of policies: the Gaussian of common/nn/actor_head.h, the squashed Gaussian of
// learner/engine/squashed_gaussian.h (Eq. 4 of docs/algorithm.md), and noise.
// Dimensions: B rows, A actions.
#pragma once

#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/numbers.h"
#include "learner/device/kernels/reduce.h"

namespace shoal::learner::kernels {

// Range of log deviations, as in common/nn/actor_head.cpp.
constexpr float kSmoothLow = -5, kSmoothHalfRange = 3.5f;
constexpr float kClampLow = -20, kClampHigh = 2;

// Splits the outputs (mean, r) of a policy's network (B, 2A):
//
//   clamped: log_std = r clamped to [-20, 2];   else log_std = -5 + 3.5 (tanh(r) + 1)
struct GaussianHead {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  int rows = 0, actions = 0;
  bool clamped = false;
  const float* output = nullptr;              // (B, 2A)
  float *mean = nullptr, *log_std = nullptr;  // (B, A)

  int blocks() const { return BlocksForElements(int64_t{rows} * actions); }
  bool operator==(const GaussianHead&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForElements(block, block.index(), int64_t(rows) * actions, [&](int64_t at) {
      const float* row = output + at / actions * 2 * actions + at % actions;
      const float raw = row[actions];
      mean[at] = row[0];
      log_std[at] = clamped ? Clamp(raw, kClampLow, kClampHigh)
                            : kSmoothLow + kSmoothHalfRange * (std::tanh(raw) + 1);
    });
  }
};

// Gradient of the network's outputs (B, 2A) from dL/dmean and dL/dlog_std (B, A).
struct GaussianHeadBackward {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  int rows = 0, actions = 0;
  bool clamped = false;
  const float *output = nullptr, *log_std = nullptr;
  const float *mean_gradient = nullptr, *log_std_gradient = nullptr;
  Target output_gradient = {};

  int blocks() const { return BlocksForElements(int64_t{rows} * actions); }
  bool operator==(const GaussianHeadBackward&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForElements(block, block.index(), int64_t(rows) * actions, [&](int64_t at) {
      const int64_t to = at / actions * 2 * actions + at % actions;
      output_gradient.Set(to, mean_gradient[at]);
      output_gradient.Set(to + actions, log_std_gradient[at] * Slope(at, output[to + actions]));
    });
  }

 private:
  // dlog_std/dr
  SHOAL_KERNEL float Slope(int64_t at, float raw) const {
    if (clamped) return raw >= kClampLow && raw <= kClampHigh ? 1.f : 0.f;
    const float t = (log_std[at] - kSmoothLow) / kSmoothHalfRange - 1;
    return kSmoothHalfRange * (1 - t * t);
  }
};

// action = tanh(mean), n numbers.
struct TanhHead {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  int64_t n = 0;
  const float* mean = nullptr;
  float* action = nullptr;

  int blocks() const { return BlocksForElements(n); }
  bool operator==(const TanhHead&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForElements(block, block.index(), n, [&](int64_t i) { action[i] = std::tanh(mean[i]); });
  }
};

// dL/dmean = dL/daction (1 - action^2) + 2 mean_penalty mean / n, n numbers.
struct TanhHeadBackward {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  int64_t n = 0;
  float penalty_slope = 0;  // 2 mean_penalty / n
  const float *mean = nullptr, *action = nullptr, *action_gradient = nullptr;
  Target mean_gradient = {};

  int blocks() const { return BlocksForElements(n); }
  bool operator==(const TanhHeadBackward&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForElements(block, block.index(), n, [&](int64_t i) {
      float gradient = action_gradient[i] * (1 - action[i] * action[i]);
      if (penalty_slope > 0) gradient += penalty_slope * mean[i];
      mean_gradient.Set(i, gradient);
    });
  }
};

// Samples from given noise eps (B, A), and log-probabilities (B). One block computes some rows: a
// thread for each action, then a thread for each row.
struct SampleSquashedGaussian {
  static constexpr int kThreads = 128;
  struct Shared {
    double terms[kThreads];
  };

  int rows = 0, actions = 0;
  const float *mean = nullptr, *log_std = nullptr, *noise = nullptr;  // (B, A)
  float *scaled_noise = nullptr, *action = nullptr;                   // (B, A)
  float* log_prob = nullptr;                                          // (B)

  // Rows with more actions than a block has threads take several rounds.
  SHOAL_EVERYWHERE int rows_of_block() const { return Most(1, kThreads / actions); }
  int blocks() const { return int(CeilDivide(rows, rows_of_block())); }
  bool operator==(const SampleSquashedGaussian&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    const int first = block.index() * rows_of_block();
    const int own_rows = Least(rows_of_block(), rows - first);
    const int numbers = own_rows * actions;  // at most kThreads, or one row
    typename Block::template Private<double> sum(block);
    block.Threads([&](int thread) { sum(thread) = 0; });
    for (int begin = 0; begin < numbers; begin += kThreads) {
      const int end = Least(numbers, begin + kThreads);
      block.Threads([&](int thread) {
        if (begin + thread >= end) return;
        shared.terms[thread] = Sample(int64_t(first) * actions + begin + thread);
      });
      block.Threads([&](int thread) {
        if (thread >= own_rows) return;
        const int row_begin = Most(thread * actions, begin);
        const int row_end = Least((thread + 1) * actions, end);
        for (int i = row_begin; i < row_end; ++i) sum(thread) += shared.terms[i - begin];
      });
    }
    block.Threads([&](int thread) {
      if (thread < own_rows) log_prob[first + thread] = float(sum(thread));
    });
  }

 private:
  // Computes one action and returns its term of the log-probability.
  SHOAL_KERNEL double Sample(int64_t at) const {
    constexpr double kLogTwo = 0.69314718055994531;
    const double eps = noise[at];
    const double scaled = std::exp(double(log_std[at])) * eps;
    const double u = mean[at] + scaled;
    // ln(1 - tanh(u)^2)
    const double softplus = Most(-2 * u, 0.0) + std::log1p(std::exp(-std::abs(2 * u)));
    const double log_slope = 2 * (kLogTwo - u - softplus);
    scaled_noise[at] = float(scaled);
    action[at] = float(std::tanh(u));
    return -0.5 * eps * eps - log_std[at] - kHalfLogTwoPi - log_slope;
  }
};

// Gradients of mean and log_std from dL/da and dL/dlog pi = temperature / B. All (B, A).
struct SquashedGaussianBackward {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  int rows = 0, actions = 0;
  const float *scaled_noise = nullptr, *action = nullptr, *action_gradient = nullptr;
  const double* temperature = nullptr;
  float *mean_gradient = nullptr, *log_std_gradient = nullptr;

  int blocks() const { return BlocksForElements(int64_t{rows} * actions); }
  bool operator==(const SquashedGaussianBackward&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    const float log_prob_gradient = float(*temperature) / float(rows);
    ForElements(block, block.index(), int64_t(rows) * actions, [&](int64_t i) {
      const float a = action[i];
      const float du = action_gradient[i] * (1 - a * a) + log_prob_gradient * 2 * a;
      mean_gradient[i] = du;
      log_std_gradient[i] = du * scaled_noise[i] - log_prob_gradient;
    });
  }
};

SHOAL_KERNEL bool IsSaturated(float action) { return std::abs(action) > 0.99f; }

// entropy = -mean log pi, and the share of |action| > 0.99; both rounded to f32.
struct SquashedGaussianFigures {
  static constexpr int kThreads = 256;
  struct Shared {
    Reduction<Sums<2>, kThreads> sums;
  };

  int rows = 0, actions = 0;
  const float *log_prob = nullptr, *action = nullptr;  // (B), (B, A)
  double *entropy = nullptr, *saturation = nullptr;

  int blocks() const { return 1; }
  bool operator==(const SquashedGaussianFigures&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    block.Threads([&](int thread) {
      auto sums = Sums<2>::Zero();
      ForAll<kThreads>(thread, rows, [&](int64_t b) { sums[0] -= double(log_prob[b]); });
      ForAll<kThreads>(thread, int64_t(rows) * actions,
                       [&](int64_t i) { sums[1] += IsSaturated(action[i]) ? 1 : 0; });
      shared.sums.of_thread[thread] = sums;
    });
    const Sums<2> total = Combine(block, shared.sums);
    block.Threads([&](int thread) {
      if (thread != 0) return;
      SetNumber(entropy, float(total[0] / rows));
      SetNumber(saturation, float(total[1] / (double(rows) * actions)));
    });
  }
};

// noisy = clip(action + clip(sigma eps, -limit, limit), -1, 1) with given noise eps, n numbers. The
// noise is in double, as it is drawn.
struct AddClippedNoise {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  int64_t n = 0;
  double sigma = 0, limit = 0;
  const float* action = nullptr;
  const double* noise = nullptr;
  float* noisy = nullptr;

  int blocks() const { return BlocksForElements(n); }
  bool operator==(const AddClippedNoise&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForElements(block, block.index(), n, [&](int64_t i) {
      const double added = Clamp(sigma * noise[i], -limit, limit);
      noisy[i] = float(Clamp(action[i] + added, -1.0, 1.0));
    });
  }
};

}  // namespace shoal::learner::kernels
