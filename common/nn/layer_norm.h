// SPDX-License-Identifier: Apache-2.0
// LayerNorm over the columns of each row.
//
//   mean_b = sum_j x[b, j] / N,   var_b = sum_j (x[b, j] - mean_b)^2 / N
//   xhat[b, j] = (x[b, j] - mean_b) * rstd_b,   rstd_b = 1 / sqrt(var_b + 1e-5)
//   y[b, j] = weight_j * xhat[b, j] + bias_j
//
// Source: Ba et al. 2016, arXiv:1607.06450.
// Shapes: x, xhat, y and their gradients (B, N) f32; rstd (B); weight, bias and their gradients
// (N). Threads: rows are split over the threads of the current ThreadScope. Results do not depend
// on the number of threads.
#pragma once

namespace shoal::nn {

struct RowShape {
  int rows = 0, columns = 0;  // B, N
};

// Learned scale and shift.
struct NormWeights {
  const float *weight, *bias;
};

// Writes xhat and rstd for the backward pass. y may be x.
void LayerNormForward(const RowShape& shape, const float* x, const NormWeights& weights,
                      float* xhat, float* rstd, float* y);

// Computes the gradient of x:
//
//   g = dy * weight
//   dx[b, j] = rstd_b * (g[b, j] - sum_k g[b, k] / N - xhat[b, j] * sum_k g[b, k] xhat[b, k] / N)
//
// dx may be dy.
void LayerNormBackward(const RowShape& shape, const float* dy, const NormWeights& weights,
                       const float* xhat, const float* rstd, float* dx);

// Computes the gradients of weight and bias:
//
//   dweight_j = sum_b dy[b, j] xhat[b, j],   dbias_j = sum_b dy[b, j]
void LayerNormBackwardWeights(const RowShape& shape, const float* dy, const float* xhat,
                              float* dweight, float* dbias);

}  // namespace shoal::nn
