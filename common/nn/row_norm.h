// SPDX-License-Identifier: Apache-2.0
// LayerNorm of the rows of an array (layer_norm.h), with its parameters and what the backward pass
// needs.
//
// Dimensions: B rows, N columns.
#pragma once

#include <string>
#include <vector>

#include "common/nn/layer_norm.h"
#include "common/nn/parameter_set.h"

namespace shoal::nn {

class RowNorm {
 public:
  // Parameters: `name`.weight (N) and `name`.bias (N), borrowed.
  RowNorm(ParameterSet* parameters, const std::string& name, const RowShape& shape);

  // x, y (B, N); y may be x.
  void Forward(const float* x, float* y);
  // Computes the gradients of the parameters from dL/dy (B, N) of the last Forward.
  void BackwardParameters(const float* dy);
  // Computes dL/dx (B, N); dx may be dy.
  void BackwardInput(const float* dy, float* dx) const;

 private:
  const RowShape shape_;
  const Parameter weight_, bias_;
  std::vector<float> normalised_;  // xhat (B, N)
  std::vector<float> scales_;      // rstd (B)
};

}  // namespace shoal::nn
