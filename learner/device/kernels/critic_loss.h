// SPDX-License-Identifier: Apache-2.0
// Targets and loss of a critic, as in learner/engine/losses.h, with gradients and figures. Sums are
// in double. Equations are numbered in docs/algorithm.md. Dimensions: B rows; arrays are (B) f32
// unless said otherwise.
#pragma once

#include "learner/device/kernels/frame.h"
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

// The number of the smallest one; the first one on a tie.
SHOAL_KERNEL int IndexOfLeast(const float* const* q, int count, int64_t b) {
  int least = 0;
  for (int i = 1; i < count; ++i) {
    if (!(q[least][b] <= q[i][b])) least = i;
  }
  return least;
}

// Eq. 5, 18 and 20:
//   y = reward_scale r + bootstrap discount (clip(min_i q'_i, low, high) - temperature log pi')
// Eq. 30: i runs over `chosen`.
struct Targets {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  int rows = 0, critics = 0;  // critics: number of i
  const float *reward = nullptr, *bootstrap = nullptr;
  const float* next_q[kMostCritics] = {};
  const int32_t* chosen = nullptr;       // (critics), indices of next_q; null: 0 ... critics - 1
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
      float value = Clamp(LeastAt(b), low, high);
      if (next_log_prob != nullptr) value -= float(*temperature) * next_log_prob[b];
      y[b] = reward_scale * reward[b] + bootstrap[b] * discount * value;
    });
  }

 private:
  SHOAL_KERNEL float LeastAt(int64_t b) const {
    if (chosen == nullptr) return LeastOf(next_q, critics, b);
    float least = next_q[chosen[0]][b];
    for (int i = 1; i < critics; ++i) least = kernels::Least(least, next_q[chosen[i]][b]);
    return least;
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

// Eq. 6: L = sum_i mean_b (q_i - y)^2, dL/dq_i = 2 (q_i - y) / B, and the figures. Eq. 34: the
// squares are multiplied by weights, or replaced by Huber's function.
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
  const float* weights = nullptr;  // null: 1
  bool huber = false;
  float* q_gradient[kMostCritics] = {};
  float* errors = nullptr;  // max_i |q_i - y|; null: not wanted
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

  SHOAL_KERNEL double LossOf(double error) const {
    const double size = std::abs(error);
    return huber && size > 1 ? 2 * size - 1 : error * error;
  }

  // Gradients, and the sums of one thread.
  SHOAL_KERNEL void Accumulate(int thread, Shared& shared) const {
    auto sums = Sums<6>::Zero();
    Extremes extremes{INFINITY, -INFINITY};
    ForAll<kThreads>(thread, rows, [&](int64_t b) {
      const float weight = weights != nullptr ? weights[b] : 1.f;
      float largest = 0;
      for (int i = 0; i < critics; ++i) {
        const float value = q[i][b], error = value - y[b];
        q_gradient[i][b] = 2 * (huber ? Clamp(error, -1.f, 1.f) : error) / float(rows) * weight;
        sums[kLoss] += double(weight) * LossOf(double(value) - y[b]);
        sums[kAll] += value;
        largest = Most(largest, std::abs(error));
      }
      if (errors != nullptr) errors[b] = largest;
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

}  // namespace shoal::learner::kernels
