// SPDX-License-Identifier: Apache-2.0
// Targets and losses, as in learner/engine/losses.h, with their gradients and figures. Sums are in
// double. Equations are numbered in docs/algorithm.md.
// Dimensions: B rows, A actions, L labels; arrays are (B) f32 unless said otherwise.
#pragma once

#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/gaussian.h"
#include "learner/device/kernels/numbers.h"
#include "learner/device/kernels/reduce.h"

namespace shoal::learner::kernels {

constexpr int kMostCritics = 16;

// The smallest of several Q functions at row b.
SHOAL_KERNEL float LeastOf(const float* const* q, int count, int64_t b) {
  float least = q[0][b];
  for (int i = 1; i < count; ++i) least = Least(least, q[i][b]);
  return least;
}

// Eq. 5, 18 and 20:
//   y = reward_scale r + bootstrap discount (clip(min_i q'_i, low, high) - temperature log pi')
struct Targets {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  int rows = 0, critics = 0;
  const float *reward = nullptr, *bootstrap = nullptr;
  const float* next_q[kMostCritics] = {};
  const float* next_log_prob = nullptr;  // null: no entropy term
  const double* temperature = nullptr;   // read if there is an entropy term
  float reward_scale = 1, discount = 1;
  float low = 0, high = 0;
  float* y = nullptr;

  int blocks() const { return BlocksForElements(rows); }
  bool operator==(const Targets&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForElements(block, block.index(), rows, [&](int64_t b) {
      float value = Clamp(LeastOf(next_q, critics, b), low, high);
      if (next_log_prob != nullptr) value -= float(*temperature) * next_log_prob[b];
      y[b] = reward_scale * reward[b] + bootstrap[b] * discount * value;
    });
  }
};

// Eq. 15: replaces each group of `copies` consecutive targets by the mean of its first `averaged`
// targets. `copies` divides the rows.
struct AverageCopies {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  int rows = 0, copies = 1, averaged = 1;
  float* y = nullptr;

  int blocks() const { return BlocksForElements(rows / copies); }
  bool operator==(const AverageCopies&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForElements(block, block.index(), rows / copies, [&](int64_t group) {
      float* of_group = y + group * copies;
      double sum = 0;
      for (int i = 0; i < averaged; ++i) sum += of_group[i];
      for (int i = 0; i < copies; ++i) of_group[i] = float(sum / averaged);
    });
  }
};

// Figures of a critic's loss (CriticNumbers); null: not wanted.
struct CriticFigures {
  double *loss = nullptr, *q_mean = nullptr, *target_mean = nullptr;
  double *q1_mean = nullptr, *q1_std = nullptr, *q2_mean = nullptr, *q2_std = nullptr;
  double *q_min_mean = nullptr, *q_min_std = nullptr, *q_min_min = nullptr, *q_min_max = nullptr;

  bool operator==(const CriticFigures&) const = default;
};

// Eq. 6: L = sum_i mean_b (q_i - y)^2, dL/dq_i = 2 (q_i - y) / B, and the figures.
struct CriticLoss {
  static constexpr int kThreads = 256;
  struct Shared {
    Reduction<Sums<6>, kThreads> sums;
    Reduction<Sums<3>, kThreads> squares;
    Reduction<Extremes, kThreads> extremes;
  };

  int rows = 0, critics = 0;
  const float* q[kMostCritics] = {};
  const float* y = nullptr;
  float* q_gradient[kMostCritics] = {};
  CriticFigures figures = {};

  int blocks() const { return 1; }
  bool operator==(const CriticLoss&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    block.Threads([&](int thread) { Accumulate(thread, shared); });
    const Sums<6> total = Combine(block, shared.sums);
    const Extremes extremes = Combine(block, shared.extremes);
    const double first = total[kFirst] / rows, second = total[kSecond] / rows;
    const double least = total[kLeast] / rows;
    block.Threads([&](int thread) {
      auto sums = Sums<3>::Zero();
      ForAll<kThreads>(thread, rows, [&](int64_t b) {
        sums[0] += Square(q[0][b] - first);
        if (critics > 1) sums[1] += Square(q[1][b] - second);
        sums[2] += Square(LeastOf(q, critics, b) - least);
      });
      shared.squares.of_thread[thread] = sums;
    });
    const Sums<3> squares = Combine(block, shared.squares);
    block.Threads([&](int thread) {
      if (thread == 0) SetFigures(total, squares, extremes);
    });
  }

 private:
  enum { kLoss, kAll, kTarget, kFirst, kSecond, kLeast };

  SHOAL_KERNEL static double Square(double x) { return x * x; }

  // Gradients, and the sums of one thread.
  SHOAL_KERNEL void Accumulate(int thread, Shared& shared) const {
    auto sums = Sums<6>::Zero();
    Extremes extremes{INFINITY, -INFINITY};
    ForAll<kThreads>(thread, rows, [&](int64_t b) {
      for (int i = 0; i < critics; ++i) {
        const float value = q[i][b];
        q_gradient[i][b] = 2 * (value - y[b]) / float(rows);
        sums[kLoss] += Square(double(value) - y[b]);
        sums[kAll] += value;
      }
      const float least = LeastOf(q, critics, b);
      sums[kTarget] += y[b];
      sums[kFirst] += q[0][b];
      if (critics > 1) sums[kSecond] += q[1][b];
      sums[kLeast] += least;
      extremes.Add({least, least});
    });
    shared.sums.of_thread[thread] = sums;
    shared.extremes.of_thread[thread] = extremes;
  }

  SHOAL_KERNEL void SetFigures(const Sums<6>& total, const Sums<3>& squares,
                               const Extremes& extremes) const {
    SetNumber(figures.loss, float(total[kLoss] / rows));
    SetNumber(figures.q_mean, float(total[kAll] / (double(critics) * rows)));
    SetNumber(figures.target_mean, float(total[kTarget] / rows));
    SetNumber(figures.q1_mean, total[kFirst] / rows);
    SetNumber(figures.q1_std, std::sqrt(squares[0] / rows));
    if (critics > 1) {
      SetNumber(figures.q2_mean, total[kSecond] / rows);
      SetNumber(figures.q2_std, std::sqrt(squares[1] / rows));
    }
    SetNumber(figures.q_min_mean, total[kLeast] / rows);
    SetNumber(figures.q_min_std, std::sqrt(squares[2] / rows));
    SetNumber(figures.q_min_min, extremes.least);
    SetNumber(figures.q_min_max, extremes.most);
  }
};

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

// Eq. 19: L = -mean_b q + mean_penalty mean_ba m^2, rounded to f32; dL/dq = -1 / B. m (B, A): the
// policy's outputs before tanh. saturation: the share of |action| > 0.99.
struct DeterministicActorLoss {
  static constexpr int kThreads = 256;
  struct Shared {
    Reduction<Sums<3>, kThreads> sums;
  };

  int rows = 0, actions = 0;
  const float *q = nullptr, *mean = nullptr, *action = nullptr;  // (B), (B, A), (B, A)
  double mean_penalty = 0;
  float* q_gradient = nullptr;
  double *loss = nullptr, *saturation = nullptr;

  int blocks() const { return 1; }
  bool operator==(const DeterministicActorLoss&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    const int64_t numbers = int64_t(rows) * actions;
    block.Threads([&](int thread) {
      auto sums = Sums<3>::Zero();
      ForAll<kThreads>(thread, rows, [&](int64_t b) {
        q_gradient[b] = -1.f / float(rows);
        sums[0] -= double(q[b]);
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
