// SPDX-License-Identifier: Apache-2.0
#include "common/nn/activations.h"

#include <Eigen/Core>

#include "common/base/cpu_clones.h"
#include "common/nn/exp_of_negative.h"

namespace shoal::nn {

SHOAL_CPU_CLONES void ReluForward(int n, const float* x, float* y) {
  for (int i = 0; i < n; ++i) y[i] = x[i] < 0 ? 0.f : x[i];
}

SHOAL_CPU_CLONES void ReluBackward(int n, const float* y, const float* dy, float* dx) {
  for (int i = 0; i < n; ++i) dx[i] = y[i] > 0 ? dy[i] : 0.f;
}

SHOAL_CPU_CLONES void EluForward(int n, const float* x, float* y) {
#pragma omp simd
  for (int i = 0; i < n; ++i) y[i] = x[i] > 0 ? x[i] : ExpOfNegative(x[i]) - 1.f;
}

SHOAL_CPU_CLONES void EluBackward(int n, const float* y, const float* dy, float* dx) {
#pragma omp simd
  for (int i = 0; i < n; ++i) dx[i] = y[i] > 0 ? dy[i] : dy[i] * (y[i] + 1.f);
}

void TanhForward(int n, const float* x, float* y) {
  Eigen::Map<Eigen::ArrayXf>(y, n) = Eigen::Map<const Eigen::ArrayXf>(x, n).tanh();
}

SHOAL_CPU_CLONES void TanhBackward(int n, const float* y, const float* dy, float* dx) {
  for (int i = 0; i < n; ++i) dx[i] = dy[i] * (1.f - y[i] * y[i]);
}

}  // namespace shoal::nn
