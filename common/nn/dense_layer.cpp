// SPDX-License-Identifier: Apache-2.0
#include "common/nn/dense_layer.h"

#include "common/base/check.h"
#include "common/nn/activations.h"
#include "common/nn/layer_norm.h"

namespace shoal::nn {

DenseLayer::DenseLayer(const LayerContext& context, const LayerPlan& plan,
                       const dnnl::memory& source, const dnnl::memory& source_gradient,
                       Precision output_precision, const Rows* skip)
    : linear_(context, plan.name, source, source_gradient, output_precision),
      skip_(skip),
      activation_(plan.activation),
      has_norm_(plan.layer_norm) {
  CHECK(skip == nullptr || (!has_norm_ && skip->size() == output().size())) << plan.name;
  if (!has_norm_) return;
  norm_weight_ = context.parameters->Find(plan.name + ".norm.weight");
  norm_bias_ = context.parameters->Find(plan.name + ".norm.bias");
  normalised_.resize(size_t(output().size()));
  scales_.resize(size_t(context.batch));
}

void DenseLayer::Forward() {
  linear_.Forward();
  Rows& output = linear_.output();
  float* y = output.values();
  if (has_norm_) {
    LayerNormForward({output.batch(), output.columns()}, y,
                     {norm_weight_.value(), norm_bias_.value()}, normalised_.data(), scales_.data(),
                     y);
  }
  if (skip_ != nullptr) {
    for (int i = 0; i < output.size(); ++i) y[i] += skip_->values()[i];
  }
  switch (activation_) {
    case Activation::kNone:
      break;
    case Activation::kRelu:
      ReluForward(output.size(), y, y);
      break;
    case Activation::kTanh:
      TanhForward(output.size(), y, y);
      break;
    case Activation::kElu:
      EluForward(output.size(), y, y);
      break;
  }
  output.Commit();
}

void DenseLayer::Backward(Gradients wanted) {
  const Rows& output = linear_.output();
  float* gradient = linear_.output_gradient().values();
  switch (activation_) {
    case Activation::kNone:
      break;
    case Activation::kRelu:
      ReluBackward(output.size(), output.values(), gradient, gradient);
      break;
    case Activation::kTanh:
      TanhBackward(output.size(), output.values(), gradient, gradient);
      break;
    case Activation::kElu:
      EluBackward(output.size(), output.values(), gradient, gradient);
      break;
  }
  if (has_norm_) {
    const RowShape shape{output.batch(), output.columns()};
    if (wanted.parameters) {
      LayerNormBackwardWeights(shape, gradient, normalised_.data(), norm_weight_.gradient(),
                               norm_bias_.gradient());
    }
    LayerNormBackward(shape, gradient, {norm_weight_.value(), norm_bias_.value()},
                      normalised_.data(), scales_.data(), gradient);
  }
  linear_.Backward(wanted);
}

}  // namespace shoal::nn
