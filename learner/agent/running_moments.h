// SPDX-License-Identifier: Apache-2.0
// Mean and variance of all vectors seen so far, taken over batch by batch.
//
// Source: Chan et al. 1983, "Algorithms for computing the sample variance".
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/nn/safetensors.h"

namespace shoal::learner {

// Mean and variance of vectors of V numbers. One thread.
class RunningMoments {
 public:
  explicit RunningMoments(int size);

  // rows (N, V).
  void Add(std::span<const float> rows);

  double count() const { return count_; }
  // (V) f32: 0 and 1 before any vector.
  std::vector<float> Mean() const;
  std::vector<float> Variance() const;

  // Exports tensor `name` of 1 + 2V doubles, bit for bit (U64).
  void Export(const std::string& name, nn::TensorMap* tensors) const;
  // Throws Error naming the tensor that is missing or of another shape; nothing has changed then.
  void Import(const nn::TensorMap& tensors, const std::string& name, const std::string& source);

 private:
  double count_ = 0;
  std::vector<double> mean_, squares_;  // (V): mean; sum of squared distances from it
};

}  // namespace shoal::learner
