// SPDX-License-Identifier: Apache-2.0
// Activations of n numbers in f32, and their gradients. Functions may be called from any thread.
#pragma once

namespace shoal::nn {

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
