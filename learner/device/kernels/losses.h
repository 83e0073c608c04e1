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

// Eq. 7: L = mean_b (temperature log pi - min(q_0, q_1)), rounded to f32; dL/dq_i = -1 / B for the
// smaller of the two (q_0 on a tie), else 0.
struct EntropyActorLoss {
  static constexpr int kThreads = 256;
  struct Shared {
    Reduction<Sums<1>, kThreads> sum;
  };

  int rows = 0;
  const float *log_prob = nullptr, *q0 = nullptr, *q1 = nullptr;
  const double* temperature = nullptr;
  float *q0_gradient = nullptr, *q1_gradient = nullptr;
  double* loss = nullptr;

  int blocks() const { return 1; }
  bool operator==(const EntropyActorLoss&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    block.Threads([&](int thread) {
      const auto weight = double(float(*temperature));
      auto sum = Sums<1>::Zero();
      ForAll<kThreads>(thread, rows, [&](int64_t b) {
        const bool first = q0[b] <= q1[b];
        q0_gradient[b] = first ? -1.f / float(rows) : 0.f;
        q1_gradient[b] = first ? 0.f : -1.f / float(rows);
        sum[0] += weight * log_prob[b] - Least(q0[b], q1[b]);
      });
      shared.sum.of_thread[thread] = sum;
    });
    const double total = Combine(block, shared.sum)[0];
    block.Threads([&](int thread) {
      if (thread == 0) *loss = float(total / rows);
    });
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
        int smallest = 0;
        for (int i = 1; i < critics; ++i) {
          if (q[i][b] < q[smallest][b]) smallest = i;
        }
        for (int i = 0; i < critics; ++i)
          q_gradient[i][b] = i == smallest ? -1.f / float(rows) : 0.f;
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
