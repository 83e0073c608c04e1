// SPDX-License-Identifier: Apache-2.0
// LayerNorm over the columns of each row, and the activations that follow it.
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

// y = max(x, 0); NaN stays NaN.
void ReluForward(int n, const float* x, float* y);
// dx = dy where y > 0, else 0. dx may be dy.
void ReluBackward(int n, const float* y, const float* dy, float* dx);

// y = x where x > 0, else exp(x) - 1; y may be x. Absolute error below 1e-6.
void EluForward(int n, const float* x, float* y);
// dx = dy where y > 0, else dy * (y + 1). dx may be dy.
void EluBackward(int n, const float* y, const float* dy, float* dx);

// y = tanh(x); y may be x. Absolute error below 1e-6.
void TanhForward(int n, const float* x, float* y);
// dx = dy * (1 - y^2). dx may be dy.
void TanhBackward(int n, const float* y, const float* dy, float* dx);

}  // namespace shoal::nn
