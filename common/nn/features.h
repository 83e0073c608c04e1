// SPDX-License-Identifier: Apache-2.0
// Output of an encoder for the heads above it, in the memory of its engine. Opaque outside of
// common/nn.
#pragma once

#include "common/nn/layer_context.h"
#include "common/nn/module.h"

namespace shoal::nn {

class Features {
 public:
  Features(const dnnl::memory& values, const dnnl::memory& gradient)
      : values_(values), gradient_(gradient) {}

  // (B, N*h*w) row-major in the compute type.
  const dnnl::memory& values() const { return values_; }
  // dL/dvalues; empty in inference.
  const dnnl::memory& gradient() const { return gradient_; }

 private:
  dnnl::memory values_, gradient_;
};

// Memory of the features that a head reads and of the gradient that it writes. Both are empty
// without pixels; the gradient is empty if the head does not train the encoder.
struct FeatureSource {
  dnnl::memory values, gradient;
};
inline FeatureSource ToFeatureSource(const Features* features, bool trains_encoder) {
  if (features == nullptr) return {};
  return {features->values(), trains_encoder ? features->gradient() : dnnl::memory()};
}

// Returns the context with which the layers of a module are built.
inline LayerContext ToLayerContext(ParameterSet* parameters, Module::Use use,
                                   const ModuleContext& context) {
  return {.parameters = parameters,
          .precision = context.precision,
          .batch = context.batch,
          .training = use == Module::Use::kTraining,
          .scratchpad = context.scratchpad,
          .plain_gradients = context.replica != nullptr && context.replica->count() > 1};
}

}  // namespace shoal::nn
