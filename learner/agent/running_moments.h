// SPDX-License-Identifier: Apache-2.0
// Moments (learner/engine/moments.h) on the host, and functions that store moments as tensors of an
// agent's state.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/nn/safetensors.h"
#include "learner/engine/moments.h"

namespace shoal::learner {

// Writes the moments, bit for bit, as tensor `name` (U64).
void ExportMoments(std::span<const double> moments, const std::string& name,
                   nn::TensorMap* tensors);
// Reads tensor `name`. Throws Error that names the tensor if the tensor is missing or does not
// contain the moments of `width` numbers.
std::vector<double> ImportMoments(size_t width, const std::string& name,
                                  const nn::TensorMap& tensors, const std::string& source);

// Mean and variance of vectors of V numbers. Only one thread may use an object.
class RunningMoments {
 public:
  explicit RunningMoments(int size) : moments_(MomentsSize(size_t(size))) {}

  // Adds N vectors; rows: (N, V).
  void Add(std::span<const float> rows) { AddToMoments(rows, moments_); }

  double count() const { return moments_[0]; }
  // Mean and variance (V) as f32; 0 and 1 if no vector was added yet.
  std::vector<float> Mean() const { return MeanOf(moments_); }
  std::vector<float> Variance() const { return VarianceOf(moments_); }

  void Export(const std::string& name, nn::TensorMap* tensors) const {
    ExportMoments(moments_, name, tensors);
  }
  // On an error, throws Error and changes nothing.
  void Import(const nn::TensorMap& tensors, const std::string& name, const std::string& source) {
    moments_ = ImportMoments(moments_.size() / 2, name, tensors, source);
  }

 private:
  std::vector<double> moments_;
};

}  // namespace shoal::learner
