// SPDX-License-Identifier: Apache-2.0
// Scales the observations of a policy to about mean 0 and deviation 1.
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

  // Scales x (B, V) into y (B, V); the size of y gives B. y may be x.
  void Apply(const float* x, std::span<float> y) const;

  // y = clip((x - mean) * factor, -kLimit, kLimit), with mean and factor (V).
  static constexpr float kLimit = 10;
  std::span<const float> mean() const { return mean_; }
  std::span<const float> factor() const { return factor_; }

 private:
  std::vector<float> mean_, factor_;  // (V)
};

// Reads the scale from a policy's tensors (kObservationMean, kObservationVariance). Empty if the
// policy has no scale. Throws Error naming a missing tensor or a wrong type or shape.
std::optional<VectorScale> ReadVectorScale(const TensorViews& tensors, int vector_size,
                                           const std::string& source);

}  // namespace shoal::nn
