// SPDX-License-Identifier: Apache-2.0
// Output of an encoder or a trunk of the CPU's networks.
//
// Dimensions: B batch, (N, h, w) of the feature map.
#pragma once

#include "common/base/check.h"
#include "common/nn/layer_context.h"
#include "common/nn/module.h"
#include "common/nn/networks.h"
#include "common/nn/primitive_descs.h"

namespace shoal::nn {

class HostFeatures final : public Features {
 public:
  HostFeatures(const dnnl::memory& values, const dnnl::memory& gradient)
      : values_(values), gradient_(gradient) {}

  int columns() const override { return int(DimsOf(values_)[1]); }

  // (B, N*h*w) row-major in the compute type.
  const dnnl::memory& values() const { return values_; }
  // dL/dvalues; empty in inference.
  const dnnl::memory& gradient() const { return gradient_; }

 private:
  dnnl::memory values_, gradient_;
};

// CHECKs that a network of the CPU computes the features.
inline const HostFeatures& OnHost(const Features& features) {
  const auto* on_host = dynamic_cast<const HostFeatures*>(&features);
  CHECK(on_host != nullptr) << "features of another engine";
  return *on_host;
}

// Memory of the features that a head reads, and memory to which the head writes their gradient.
// Without pixels, both memories are empty. If the head does not train the encoder, the memory of
// the gradient is empty.
struct FeatureSource {
  dnnl::memory values, gradient;
};
inline FeatureSource ToFeatureSource(const Features* features, bool trains_encoder) {
  if (features == nullptr) return {};
  const HostFeatures& on_host = OnHost(*features);
  return {on_host.values(), trains_encoder ? on_host.gradient() : dnnl::memory()};
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
