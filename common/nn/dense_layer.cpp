// SPDX-License-Identifier: Apache-2.0
#include "common/nn/dense_layer.h"

#include "common/base/check.h"
#include "common/nn/layer_norm.h"

namespace shoal::nn {

DenseLayer::DenseLayer(const LayerContext& context, const LayerPlan& plan,
                       const dnnl::memory& source, const dnnl::memory& source_gradient,
                       Precision output_precision)
    : linear_(context, plan.name, source, source_gradient),
      activation_(plan.activation),
      has_norm_(plan.layer_norm),
      output_(context.batch, linear_.outputs(), output_precision) {
  CHECK(activation_ != Activation::kNone) << plan.name << ": a linear layer alone is a Linear";
  if (!has_norm_) return;
  norm_weight_ = context.parameters->Find(plan.name + ".norm.weight");
  norm_bias_ = context.parameters->Find(plan.name + ".norm.bias");
  normalised_.resize(size_t(output_.size()));
  scales_.resize(size_t(context.batch));
}

void DenseLayer::Forward() {
  linear_.Forward();
  const float* x = linear_.output();
  float* y = output_.values();
  if (has_norm_) {
    LayerNormForward({output_.batch(), output_.columns()}, x,
                     {norm_weight_.value(), norm_bias_.value()}, normalised_.data(), scales_.data(),
                     y);
    x = y;
  }
  if (activation_ == Activation::kTanh) {
    TanhForward(output_.size(), x, y);
  } else {
    ReluForward(output_.size(), x, y);
  }
  output_.Commit();
}

void DenseLayer::Backward(const float* output_gradient, Gradients wanted) {
  float* dx = linear_.output_gradient();
  if (activation_ == Activation::kTanh) {
    TanhBackward(output_.size(), output_.values(), output_gradient, dx);
  } else {
    ReluBackward(output_.size(), output_.values(), output_gradient, dx);
  }
  if (has_norm_) {
    const RowShape shape{output_.batch(), output_.columns()};
    if (wanted.parameters) {
      LayerNormBackwardWeights(shape, dx, normalised_.data(), norm_weight_.gradient(),
                               norm_bias_.gradient());
    }
    LayerNormBackward(shape, dx, {norm_weight_.value(), norm_bias_.value()}, normalised_.data(),
                      scales_.data(), dx);
  }
  linear_.Backward(wanted);
}

}  // namespace shoal::nn
