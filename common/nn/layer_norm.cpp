// SPDX-License-Identifier: Apache-2.0
#include "common/nn/layer_norm.h"

#include <cmath>
#include <cstdint>

#include "common/base/cpu_clones.h"
#include "common/nn/parallel.h"

namespace shoal::nn {
namespace {

constexpr float kLayerEpsilon = 1e-5f;
constexpr int kMinParallel = 1 << 17;  // elements below which waking other threads costs more

// Runs body(begin, end) over rows, in parallel if there is enough to do.
template <class Body>
void ForRows(const RowShape& shape, const Body& body) {
  if (int64_t(shape.rows) * shape.columns < kMinParallel) {
    body(0, shape.rows);
  } else {
    ParallelFor(shape.rows, body);
  }
}

SHOAL_CPU_CLONES void NormaliseRow(const float* x, int n, const NormWeights& weights, float* xhat,
                                   float* rstd, float* y) {
  float sum = 0;
#pragma omp simd reduction(+ : sum)
  for (int j = 0; j < n; ++j) sum += x[j];
  const float mean = sum / float(n);
  float squares = 0;
#pragma omp simd reduction(+ : squares)
  for (int j = 0; j < n; ++j) squares += (x[j] - mean) * (x[j] - mean);
  const float scale = 1.f / std::sqrt(squares / float(n) + kLayerEpsilon);
  *rstd = scale;
  const float* weight = weights.weight;
  const float* bias = weights.bias;
#pragma omp simd
  for (int j = 0; j < n; ++j) {
    xhat[j] = (x[j] - mean) * scale;
    y[j] = weight[j] * xhat[j] + bias[j];
  }
}

SHOAL_CPU_CLONES void NormaliseRowBackward(const float* dy, int n, const float* weight,
                                           const float* xhat, float rstd, float* dx) {
  float sum = 0, dot = 0;
#pragma omp simd reduction(+ : sum, dot)
  for (int j = 0; j < n; ++j) {
    const float g = dy[j] * weight[j];
    sum += g;
    dot += g * xhat[j];
  }
  const float mean = sum / float(n), correlation = dot / float(n);
#pragma omp simd
  for (int j = 0; j < n; ++j) {
    dx[j] = rstd * (dy[j] * weight[j] - mean - xhat[j] * correlation);
  }
}

SHOAL_CPU_CLONES void SumColumns(const RowShape& shape, const float* dy, const float* xhat,
                                 float* __restrict dweight, float* __restrict dbias) {
  for (int j = 0; j < shape.columns; ++j) dweight[j] = dbias[j] = 0;
  for (int b = 0; b < shape.rows; ++b) {
    const float* dy_row = dy + int64_t(b) * shape.columns;
    const float* xhat_row = xhat + int64_t(b) * shape.columns;
    for (int j = 0; j < shape.columns; ++j) {
      dweight[j] += dy_row[j] * xhat_row[j];
      dbias[j] += dy_row[j];
    }
  }
}

}  // namespace

void LayerNormForward(const RowShape& shape, const float* x, const NormWeights& weights,
                      float* xhat, float* rstd, float* y) {
  ForRows(shape, [&](int begin, int end) {
    for (int b = begin; b < end; ++b) {
      const int64_t row = int64_t(b) * shape.columns;
      NormaliseRow(x + row, shape.columns, weights, xhat + row, rstd + b, y + row);
    }
  });
}

void LayerNormBackward(const RowShape& shape, const float* dy, const NormWeights& weights,
                       const float* xhat, const float* rstd, float* dx) {
  ForRows(shape, [&](int begin, int end) {
    for (int b = begin; b < end; ++b) {
      const int64_t row = int64_t(b) * shape.columns;
      NormaliseRowBackward(dy + row, shape.columns, weights.weight, xhat + row, rstd[b], dx + row);
    }
  });
}

void LayerNormBackwardWeights(const RowShape& shape, const float* dy, const float* xhat,
                              float* dweight, float* dbias) {
  SumColumns(shape, dy, xhat, dweight, dbias);
}

}  // namespace shoal::nn
