// SPDX-License-Identifier: Apache-2.0
#include "common/nn/row_norm.h"

namespace shoal::nn {

RowNorm::RowNorm(ParameterSet* parameters, const std::string& name, const RowShape& shape)
    : shape_(shape),
      weight_(parameters->Find(name + ".weight")),
      bias_(parameters->Find(name + ".bias")),
      normalised_(size_t(shape.rows) * size_t(shape.columns)),
      scales_(size_t(shape.rows)) {}

void RowNorm::Forward(const float* x, float* y) {
  LayerNormForward(shape_, x, {weight_.value(), bias_.value()}, normalised_.data(), scales_.data(),
                   y);
}

void RowNorm::BackwardParameters(const float* dy) {
  LayerNormBackwardWeights(shape_, dy, normalised_.data(), weight_.gradient(), bias_.gradient());
}

void RowNorm::BackwardInput(const float* dy, float* dx) const {
  LayerNormBackward(shape_, dy, {weight_.value(), bias_.value()}, normalised_.data(),
                    scales_.data(), dx);
}

}  // namespace shoal::nn
