// SPDX-License-Identifier: Apache-2.0
// LayerNorm with the bias of the linear layer before it and the activation behind it, and the
// backward pass. Dimensions, functions and steps: layers.h. Formulas: common/nn/layer_norm.h.
#pragma once

#include "learner/device/kernels/layers.h"

namespace shoal::learner::kernels {

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

}  // namespace shoal::learner::kernels
