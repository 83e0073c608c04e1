// SPDX-License-Identifier: Apache-2.0
// Policies' actions from the outputs of their networks, and the backward passes: the heads of
// common/nn/actor_head.h.
// Dimensions: B rows, A actions.
#pragma once

#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/numbers.h"

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

}  // namespace shoal::learner::kernels
