// SPDX-License-Identifier: Apache-2.0
// The squashed Gaussian of learner/engine/squashed_gaussian.h (Eq. 4 of docs/algorithm.md), figures
// of a Gaussian, and noise. Dimensions: B rows, A actions.
#pragma once

#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/numbers.h"
#include "learner/device/kernels/reduce.h"

namespace shoal::learner::kernels {

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
  const double* sigma = nullptr;
  double limit = 0;
  const float* action = nullptr;
  const double* noise = nullptr;
  float* noisy = nullptr;

  int blocks() const { return BlocksForElements(n); }
  bool operator==(const AddClippedNoise&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForElements(block, block.index(), n, [&](int64_t i) {
      const double added = Clamp(*sigma * noise[i], -limit, limit);
      noisy[i] = float(Clamp(action[i] + added, -1.0, 1.0));
    });
  }
};

// The mean deviation and the entropy of a Gaussian with log deviations (A).
struct GaussianFigures {
  static constexpr int kThreads = 32;
  struct Shared {
    Reduction<Sums<2>, kThreads> sums;
  };

  int actions = 0;
  const float* log_std = nullptr;
  double *deviation = nullptr, *entropy = nullptr;

  int blocks() const { return 1; }
  bool operator==(const GaussianFigures&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    block.Threads([&](int thread) {
      auto sums = Sums<2>::Zero();
      ForAll<kThreads>(thread, actions, [&](int64_t j) {
        sums[0] += std::exp(double(log_std[j]));
        sums[1] += log_std[j] + (kHalfLogTwoPi + 0.5);
      });
      shared.sums.of_thread[thread] = sums;
    });
    const Sums<2> total = Combine(block, shared.sums);
    block.Threads([&](int thread) {
      if (thread != 0) return;
      *deviation = total[0] / actions;
      *entropy = total[1];
    });
  }
};

}  // namespace shoal::learner::kernels
