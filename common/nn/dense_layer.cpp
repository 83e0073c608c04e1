// SPDX-License-Identifier: Apache-2.0
#include "common/nn/dense_layer.h"

#include "common/base/check.h"
#include "common/nn/activations.h"

namespace shoal::nn {

DenseLayer::DenseLayer(const LayerContext& context, const LayerPlan& plan,
                       const dnnl::memory& source, const dnnl::memory& source_gradient,
                       Precision output_precision, const Rows* skip)
    : linear_(context, plan.name, source, source_gradient, output_precision),
      skip_(skip),
      activation_(plan.activation) {
  CHECK(skip == nullptr || (!plan.layer_norm && skip->size() == output().size())) << plan.name;
  if (!plan.layer_norm) return;
  norm_.emplace(context.parameters, plan.name + ".norm",
                RowShape{output().batch(), output().columns()});
}

void DenseLayer::Forward() {
  linear_.Forward();
  Rows& output = linear_.output();
  float* y = output.values();
  if (norm_) norm_->Forward(y, y);
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
  if (norm_) {
    if (wanted.parameters) norm_->BackwardParameters(gradient);
    norm_->BackwardInput(gradient, gradient);
  }
  linear_.Backward(wanted);
}

}  // namespace shoal::nn
