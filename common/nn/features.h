// SPDX-License-Identifier: Apache-2.0
// Output of an encoder, which heads read, in the memory of the engine. Opaque outside of common/nn.
//
// Dimensions: B batch, (N, h, w) of the feature map.
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

// Memory of the features that a head reads, and memory to which the head writes their gradient.
// Without pixels, both memories are empty. If the head does not train the encoder, the memory of
// the gradient is empty.
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
