// SPDX-License-Identifier: Apache-2.0
// Observations of a policy at about mean 0 and deviation 1.
//
//   y_j = clip((x_j - mean_j) / sqrt(variance_j + 1e-8), -10, 10)
//
// Source: VecNormalize of Stable-Baselines3, common/vec_env/vec_normalize.py.
// Dimensions: B batch, V vector size.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/nn/safetensors.h"

namespace shoal::nn {

class VectorScale {
 public:
  // mean, variance (V).
  VectorScale(std::span<const float> mean, std::span<const float> variance);

  // x (B, V) to y (B, V), which says how many; they may be the same.
  void Apply(const float* x, std::span<float> y) const;

  // (V): y = clip((x - mean) * factor, -kLimit, kLimit).
  static constexpr float kLimit = 10;
  std::span<const float> mean() const { return mean_; }
  std::span<const float> factor() const { return factor_; }

 private:
  std::vector<float> mean_, factor_;  // (V)
};

// The scale among a policy's tensors (kObservationMean, kObservationVariance); empty if there is
// none. Throws Error naming a missing tensor or a wrong type or shape.
std::optional<VectorScale> ReadVectorScale(const TensorViews& tensors, int vector_size,
                                           const std::string& source);

}  // namespace shoal::nn
