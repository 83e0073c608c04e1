// SPDX-License-Identifier: Apache-2.0
// Layers beside their products: bias, activation, and their backward passes.
//
// Dimensions: B rows, N columns. The rows of a map (B, h, w, N) are its pixels. Arrays that a
// product reads next can be written in bf16 as well (Target).
//
// One launch can compute several functions, for example both heads of a critic: arrays are then
// (functions, B, N), and parameters and gradients of function f begin f * step floats after those
// of function 0.
#pragma once

#include "learner/device/kernels/column_sums.h"
#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/numbers.h"
#include "learner/device/kernels/reduce.h"

namespace shoal::learner::kernels {

enum class Activation : int32_t { kNone, kRelu, kTanh, kElu };

SHOAL_KERNEL float Activate(Activation activation, float x) {
  if (activation == Activation::kRelu) return x < 0 ? 0.f : x;
  if (activation == Activation::kElu) return x > 0 ? x : std::exp(x) - 1;
  return activation == Activation::kTanh ? std::tanh(x) : x;
}

// The derivative at the input whose output is y.
SHOAL_KERNEL float ActivationSlope(Activation activation, float y) {
  if (activation == Activation::kRelu) return y > 0 ? 1.f : 0.f;
  if (activation == Activation::kElu) return y > 0 ? 1.f : y + 1;
  return activation == Activation::kTanh ? 1 - y * y : 1.f;
}

// y = act(x + bias). x, y (F, B, N), bias (N) or null. y may be x.
struct BiasActivation {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  int functions = 1;
  int64_t rows = 0, step = 0;
  int columns = 0;
  Source x = {};
  const float* bias = nullptr;
  Activation activation = Activation::kNone;
  Target y = {};

  int blocks() const { return BlocksForElements(functions * rows * columns); }
  bool operator==(const BiasActivation&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForElements(block, block.index(), functions * rows * columns, [&](int64_t i) {
      const int64_t parameter = i / columns / rows * step + i % columns;
      const float shift = bias != nullptr ? bias[parameter] : 0.f;
      y.Set(i, Activate(activation, x[i] + shift));
    });
  }
};

// dx = dy where y > 0, else 0, for a map of n numbers, all in f32 or all in bf16. dx may be dy.
struct ReluBackward {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  int64_t n = 0;
  Source dy = {}, y = {};
  Target dx = {};

  int blocks() const { return InEights() ? BlocksForEights(n) : BlocksForElements(n); }
  bool operator==(const ReluBackward&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    // dy may be infinite where y is 0.
    if (!InEights()) {
      ForElements(block, block.index(), n, [&](int64_t i) { dx.Set(i, y[i] > 0 ? dy[i] : 0.f); });
      return;
    }
    ForEights(block, n, [&](int64_t first) {
      Eight gradient = ReadEight(dy.bf16 + first);
      const Eight output = ReadEight(y.bf16 + first);
      for (int k = 0; k < 8; ++k) {
        if (!(FromBf16(output.numbers[k]) > 0)) gradient.numbers[k] = 0;
      }
      WriteEight(gradient, dx.bf16 + first);
    });
  }

 private:
  SHOAL_EVERYWHERE bool InEights() const { return dx.f32 == nullptr && n % 8 == 0; }
};

// dx = dy act'(y), and the gradient of the bias: dbias_j = sum_b dx, of dx as rounded. dx may be
// dy. With Activation::kNone,
// y is not read. partials: sums.PartialsSize().
struct ActivationBackward {
  static constexpr int kThreads = ColumnSums::kThreads;
  using Shared = ColumnSums::Shared<1>;

  ColumnSums sums = {};
  int64_t step = 0;
  Source dy = {}, y = {};  // (F, B, N)
  Activation activation = Activation::kNone;
  Target dx = {};          // may be absent
  float* dbias = nullptr;  // (N); may be null

  int blocks() const { return sums.blocks(); }
  bool operator==(const ActivationBackward&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    sums.Run<1>(
        block, shared,
        [&](int64_t row, int j) {
          const int64_t at = row * sums.columns + j;
          const float slope =
              activation == Activation::kNone ? 1.f : ActivationSlope(activation, y[at]);
          // dy may be infinite where the slope is 0.
          const float gradient = slope == 0 ? 0.f : dy[at] * slope;
          dx.Set(at, gradient);
          return Sums<1, float>{{dx.bf16 != nullptr ? FromBf16(ToBf16(gradient)) : gradient}};
        },
        [&](int function, int j, const Sums<1, float>& of_column) {
          if (dbias != nullptr) dbias[function * step + j] = of_column[0];
        });
  }
};

}  // namespace shoal::learner::kernels
