// SPDX-License-Identifier: Apache-2.0
#include "common/nn/norm_layer.h"

#include "common/nn/layer_norm.h"

namespace shoal::nn {

NormLayer::NormLayer(const LayerContext& context, const LayerPlan& plan, const dnnl::memory& source,
                     const dnnl::memory& source_gradient, Precision output_precision)
    : source_(source),
      source_gradient_(source_gradient),
      output_(context.batch, plan.output.channels, output_precision),
      output_gradient_(context.batch, plan.output.channels, Precision::kF32),
      weight_(context.parameters->Find(plan.name + ".weight")),
      bias_(context.parameters->Find(plan.name + ".bias")),
      normalised_(size_t(output_.size())),
      scales_(size_t(context.batch)) {}

void NormLayer::Forward() {
  LayerNormForward(
      {output_.batch(), output_.columns()}, static_cast<const float*>(source_.get_data_handle()),
      {weight_.value(), bias_.value()}, normalised_.data(), scales_.data(), output_.values());
  output_.Commit();
}

void NormLayer::Backward(Gradients wanted) {
  const RowShape shape{output_.batch(), output_.columns()};
  const float* gradient = output_gradient_.values();
  if (wanted.parameters) {
    LayerNormBackwardWeights(shape, gradient, normalised_.data(), weight_.gradient(),
                             bias_.gradient());
  }
  if (!wanted.source) return;
  LayerNormBackward(shape, gradient, {weight_.value(), bias_.value()}, normalised_.data(),
                    scales_.data(), static_cast<float*>(source_gradient_.get_data_handle()));
}

}  // namespace shoal::nn
