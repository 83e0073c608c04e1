// SPDX-License-Identifier: Apache-2.0
// Dense layers beside their products: bias, LayerNorm, activation, and their backward passes.
// Formulas: common/nn/layer_norm.h.
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

enum class Activation : int32_t { kNone, kRelu, kTanh };

SHOAL_KERNEL float Activate(Activation activation, float x) {
  if (activation == Activation::kRelu) return x < 0 ? 0.f : x;
  return activation == Activation::kTanh ? std::tanh(x) : x;
}

// The derivative at the input whose output is y.
SHOAL_KERNEL float ActivationSlope(Activation activation, float y) {
  if (activation == Activation::kRelu) return y > 0 ? 1.f : 0.f;
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

// y = act(LN(x + linear_bias)). One block for each row. xhat and rstd are kept for the backward
// pass.
struct LayerNormForward {
  static constexpr int kThreads = 128;
  struct Shared {
    Reduction<Sums<1, float>, kThreads> sum;
  };

  int functions = 1, rows = 0, columns = 0;
  int64_t step = 0;
  const float* x = nullptr;                                                // (F, B, N)
  const float *linear_bias = nullptr, *weight = nullptr, *bias = nullptr;  // (N); first may be null
  Activation activation = Activation::kNone;
  float *xhat = nullptr, *rstd = nullptr;  // (F, B, N), (F, B)
  Target y = {};                           // (F, B, N)

  int blocks() const { return functions * rows; }
  bool operator==(const LayerNormForward&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    const int64_t row = int64_t(block.index()) * columns;
    const float mean =
        Sum(block, shared, [&](int j) { return Input(block.index(), j); }) / float(columns);
    const float squares = Sum(block, shared, [&](int j) {
      const float distance = Input(block.index(), j) - mean;
      return distance * distance;
    });
    const float scale = 1.f / std::sqrt(squares / float(columns) + 1e-5f);
    block.Threads([&](int thread) {
      if (thread == 0) rstd[block.index()] = scale;
      ForAll<kThreads>(thread, columns, [&](int64_t j) {
        const float normal = (Input(block.index(), j) - mean) * scale;
        xhat[row + j] = normal;
        const int64_t at = Parameter(block.index(), j);
        y.Set(row + j, Activate(activation, weight[at] * normal + bias[at]));
      });
    });
  }

 private:
  SHOAL_KERNEL int64_t Parameter(int row, int64_t j) const { return row / rows * step + j; }
  SHOAL_KERNEL float Input(int row, int64_t j) const {
    const float value = x[int64_t(row) * columns + j];
    return linear_bias != nullptr ? value + linear_bias[Parameter(row, j)] : value;
  }

  template <class Block, class Term>
  SHOAL_KERNEL float Sum(Block& block, Shared& shared, const Term& term) const {
    block.Threads([&](int thread) {
      auto sum = Sums<1, float>::Zero();
      ForAll<kThreads>(thread, columns, [&](int64_t j) { sum[0] += term(int(j)); });
      shared.sum.of_thread[thread] = sum;
    });
    return Combine(block, shared.sum)[0];
  }
};

// dx of the layer above from dL/dy. One block for each row. dx may be dy.
struct LayerNormBackward {
  static constexpr int kThreads = 128;
  struct Shared {
    Reduction<Sums<2, float>, kThreads> sums;
  };

  int functions = 1, rows = 0, columns = 0;
  int64_t step = 0;
  const float *dy = nullptr, *y = nullptr;  // (F, B, N); y: output of the activation
  Activation activation = Activation::kNone;
  const float *weight = nullptr, *xhat = nullptr, *rstd = nullptr;
  Target dx = {};

  int blocks() const { return functions * rows; }
  bool operator==(const LayerNormBackward&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    const int64_t row = int64_t(block.index()) * columns;
    block.Threads([&](int thread) {
      auto sums = Sums<2, float>::Zero();
      ForAll<kThreads>(thread, columns, [&](int64_t j) {
        const float g = Gradient(block.index(), j);
        sums[0] += g;
        sums[1] += g * xhat[row + j];
      });
      shared.sums.of_thread[thread] = sums;
    });
    const Sums<2, float> total = Combine(block, shared.sums);
    const float mean = total[0] / float(columns), correlation = total[1] / float(columns);
    const float scale = rstd[block.index()];
    block.Threads([&](int thread) {
      ForAll<kThreads>(thread, columns, [&](int64_t j) {
        const float g = Gradient(block.index(), j);
        dx.Set(row + j, scale * (g - mean - xhat[row + j] * correlation));
      });
    });
  }

 private:
  // dL/dxhat
  SHOAL_KERNEL float Gradient(int row, int64_t j) const {
    const int64_t at = int64_t(row) * columns + j;
    return dy[at] * ActivationSlope(activation, y[at]) * weight[row / rows * step + j];
  }
};

// Gradients of a LayerNorm's weight and bias, and of the bias of the linear layer before it:
//
//   dz = dy act'(y),   dweight_j = sum_b dz xhat,   dbias_j = sum_b dz,   dlinear_bias_j = sum_b dx
//
// Runs after LayerNormBackward, whose dx must not be dy. partials: 3 sums.PartialsSize().
struct LayerNormBackwardWeights {
  static constexpr int kThreads = ColumnSums::kThreads;
  using Shared = ColumnSums::Shared<3>;

  ColumnSums sums = {};
  int64_t step = 0;
  const float *dy = nullptr, *y = nullptr, *xhat = nullptr;  // (F, B, N)
  Source dx = {};                                            // (F, B, N)
  Activation activation = Activation::kNone;
  float *dweight = nullptr, *dbias = nullptr, *dlinear_bias = nullptr;  // (N); last may be null

  int blocks() const { return sums.blocks(); }
  bool operator==(const LayerNormBackwardWeights&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    sums.Run<3>(
        block, shared,
        [&](int64_t row, int j) {
          const int64_t at = row * sums.columns + j;
          const float dz = dy[at] * ActivationSlope(activation, y[at]);
          return Sums<3, float>{{dz * xhat[at], dz, dx[at]}};
        },
        [&](int function, int j, const Sums<3, float>& of_column) {
          const int64_t at = function * step + j;
          dweight[at] = of_column[0];
          dbias[at] = of_column[1];
          if (dlinear_bias != nullptr) dlinear_bias[at] = of_column[2];
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
