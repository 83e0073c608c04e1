// SPDX-License-Identifier: Apache-2.0
#include "common/nn/norm_layer.h"

namespace shoal::nn {

NormLayer::NormLayer(const LayerContext& context, const LayerPlan& plan, const dnnl::memory& source,
                     const dnnl::memory& source_gradient, Precision output_precision)
    : source_(source),
      source_gradient_(source_gradient),
      output_(context.batch, plan.output.channels, output_precision),
      output_gradient_(context.batch, plan.output.channels, Precision::kF32),
      norm_(context.parameters, plan.name, {output_.batch(), output_.columns()}) {}

void NormLayer::Forward() {
  norm_.Forward(static_cast<const float*>(source_.get_data_handle()), output_.values());
  output_.Commit();
}

void NormLayer::Backward(Gradients wanted) {
  const float* gradient = output_gradient_.values();
  if (wanted.parameters) norm_.BackwardParameters(gradient);
  if (wanted.source) {
    norm_.BackwardInput(gradient, static_cast<float*>(source_gradient_.get_data_handle()));
  }
}

}  // namespace shoal::nn
