// SPDX-License-Identifier: Apache-2.0
// Losses of actors and of labels, as in learner/engine/losses.h, with gradients and figures. Sums
// are in double. Equations are numbered in docs/algorithm.md. Dimensions: B rows, A actions, L
// labels; arrays are (B) f32 unless said otherwise.
#pragma once

#include "learner/device/kernels/critic_loss.h"
#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/gaussian.h"
#include "learner/device/kernels/numbers.h"
#include "learner/device/kernels/reduce.h"

namespace shoal::learner::kernels {

// Eq. 7 and 30: L = mean_b (temperature log pi - v), rounded to f32, where v is the smallest q_i or
// their mean. Smallest: dL/dq_i = -1 / B for the smallest q_i (the first one on a tie), else 0.
// Mean: dL/dq_i = -1 / (N B) for N critics.
struct EntropyActorLoss {
  static constexpr int kThreads = 256;
  struct Shared {
    Reduction<Sums<1>, kThreads> sum;
  };

  int rows = 0, critics = 0;
  bool of_mean = false;  // v is the mean
  const float* log_prob = nullptr;
  const float* q[kMostCritics] = {};
  const double* temperature = nullptr;
  float* q_gradient[kMostCritics] = {};
  double* loss = nullptr;

  int blocks() const { return 1; }
  bool operator==(const EntropyActorLoss&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    block.Threads([&](int thread) {
      const auto weight = double(float(*temperature));
      auto sum = Sums<1>::Zero();
      ForAll<kThreads>(thread, rows, [&](int64_t b) {
        const int only = of_mean ? kAllCritics : IndexOfLeast(q, critics, b);
        for (int i = 0; i < critics; ++i) q_gradient[i][b] = Gradient(i, only);
        sum[0] += weight * log_prob[b] - (of_mean ? MeanAt(b) : double(q[only][b]));
      });
      shared.sum.of_thread[thread] = sum;
    });
    const double total = Combine(block, shared.sum)[0];
    block.Threads([&](int thread) {
      if (thread == 0) *loss = float(total / rows);
    });
  }

 private:
  static constexpr int kAllCritics = -1;

  SHOAL_KERNEL double MeanAt(int64_t b) const {
    double sum = 0;
    for (int i = 0; i < critics; ++i) sum += q[i][b];
    return sum / critics;
  }

  SHOAL_KERNEL float Gradient(int i, int only) const {
    if (only == kAllCritics) return -1.f / (float(critics) * float(rows));
    return i == only ? -1.f / float(rows) : 0.f;
  }
};

// Eq. 19 and 32: L = -mean_b min_i q_i + mean_penalty mean_ba m^2, rounded to f32; dL/dq_i = -1 / B
// for the smallest (the first one on a tie), else 0. m (B, A): the policy's outputs before tanh.
// saturation: the share of |action| > 0.99.
struct DeterministicActorLoss {
  static constexpr int kThreads = 256;
  struct Shared {
    Reduction<Sums<3>, kThreads> sums;
  };

  int rows = 0, actions = 0, critics = 0;
  const float* q[kMostCritics] = {};
  const float *mean = nullptr, *action = nullptr;  // (B, A)
  double mean_penalty = 0;
  float* q_gradient[kMostCritics] = {};
  double *loss = nullptr, *saturation = nullptr;

  int blocks() const { return 1; }
  bool operator==(const DeterministicActorLoss&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    const int64_t numbers = int64_t(rows) * actions;
    block.Threads([&](int thread) {
      auto sums = Sums<3>::Zero();
      ForAll<kThreads>(thread, rows, [&](int64_t b) {
        const int smallest = IndexOfLeast(q, critics, b);
        for (int i = 0; i < critics; ++i) {
          q_gradient[i][b] = i == smallest ? -1.f / float(rows) : 0.f;
        }
        sums[0] -= double(q[smallest][b]);
      });
      ForAll<kThreads>(thread, numbers, [&](int64_t i) {
        sums[1] += double(mean[i]) * mean[i];
        sums[2] += IsSaturated(action[i]) ? 1 : 0;
      });
      shared.sums.of_thread[thread] = sums;
    });
    const Sums<3> total = Combine(block, shared.sums);
    block.Threads([&](int thread) {
      if (thread != 0) return;
      const double penalty = mean_penalty > 0 ? mean_penalty * total[1] / double(numbers) : 0;
      *loss = float(total[0] / rows + penalty);
      SetNumber(saturation, total[2] / double(numbers));
    });
  }
};

// Eq. 27: L = weight / n sum (y - label)^2 over n = B L numbers. Computes dL/dy, and the mean
// square times unit^2.
struct LabelLoss {
  static constexpr int kThreads = 256;
  struct Shared {
    Reduction<Sums<1>, kThreads> sum;
  };

  int64_t n = 0;
  const float *y = nullptr, *labels = nullptr;
  float weight = 0, unit = 1;
  Target gradient = {};
  double* mean_square = nullptr;

  int blocks() const { return 1; }
  bool operator==(const LabelLoss&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    block.Threads([&](int thread) {
      const float scale = 2 * weight / float(n);
      auto sum = Sums<1>::Zero();
      ForAll<kThreads>(thread, n, [&](int64_t i) {
        const float difference = y[i] - labels[i];
        sum[0] += double(difference) * difference;
        gradient.Set(i, scale * difference);
      });
      shared.sum.of_thread[thread] = sum;
    });
    const double total = Combine(block, shared.sum)[0];
    block.Threads([&](int thread) {
      if (thread == 0) *mean_square = double(unit) * unit * total / double(n);
    });
  }
};

// The mean of n numbers.
struct Mean {
  static constexpr int kThreads = 256;
  struct Shared {
    Reduction<Sums<1>, kThreads> sum;
  };

  int64_t n = 0;
  const float* values = nullptr;
  double* mean = nullptr;

  int blocks() const { return 1; }
  bool operator==(const Mean&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    block.Threads([&](int thread) {
      auto sum = Sums<1>::Zero();
      ForAll<kThreads>(thread, n, [&](int64_t i) { sum[0] += values[i]; });
      shared.sum.of_thread[thread] = sum;
    });
    const double total = Combine(block, shared.sum)[0];
    block.Threads([&](int thread) {
      if (thread == 0) *mean = total / double(n);
    });
  }
};

}  // namespace shoal::learner::kernels
