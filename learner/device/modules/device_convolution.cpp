// SPDX-License-Identifier: Apache-2.0
#include "learner/device/modules/device_convolution.h"

#include "common/base/check.h"
#include "learner/device/modules/dense_layer.h"

namespace shoal::learner::device {
namespace {

// Batch normalisation applies the activation itself.
kernels::Activation OwnActivation(const nn::LayerPlan& plan) {
  CHECK(plan.activation != nn::Activation::kTanh) << plan.name;
  return plan.batch_norm.empty() ? ActivationOf(plan.activation) : kernels::Activation::kNone;
}

}  // namespace

DeviceConvolution::DeviceConvolution(Workspace* workspace, const nn::LayerPlan& plan,
                                     const DeviceParameters& parameters, const MapSource& source,
                                     bool trained)
    : DeviceMapLayer(workspace),
      source_(source),
      activation_(OwnActivation(plan)),
      weight_(parameters.Find(plan.name + ".weight")),
      bias_(plan.bias ? parameters.Find(plan.name + ".bias") : Tensor()),
      has_bias_(plan.bias) {
  output_ = NewMap(workspace, plan.output, trained);
  shape_ = {.type = workspace->compute_type(),
            .batch = workspace->batch(),
            .height = plan.input.height,
            .width = plan.input.width,
            .channels = source.map.channels,
            .filters = output_.channels,
            .kernel = plan.kernel,
            .stride = plan.stride,
            .padding = plan.padding,
            .output_height = plan.output.height,
            .output_width = plan.output.width};
}

void DeviceConvolution::SetLayout(const Workspace& workspace, const nn::LayerPlan& plan,
                                  ParameterLayout* layout) {
  const int filters = plan.output.channels, padded = workspace.PaddedChannels(filters);
  layout->Set(plan.name + ".weight",
              {.outer = filters,
               .padded_outer = padded,
               .channels = plan.input.channels,
               .padded_channels = workspace.PaddedChannels(plan.input.channels),
               .pixels = int64_t{plan.kernel} * plan.kernel});
  if (plan.bias) layout->Set(plan.name + ".bias", {.outer = filters, .padded_outer = padded});
}

void DeviceConvolution::Forward(nn::Statistics) {
  workspace_->Add(ConvolutionForward{.shape = shape_,
                                     .x = source_.map.values,
                                     .weight = weight_.As(shape_.type),
                                     .bias = bias_.value,
                                     .relu = activation_ == kernels::Activation::kRelu,
                                     .y = output_.values});
}

void DeviceConvolution::Backward() {
  // The gradient of the numbers before the activation replaces that of the output.
  if (activation_ == kernels::Activation::kRelu) {
    workspace_->Add(kernels::ReluBackward{.n = workspace_->batch() * output_.PixelNumbers(),
                                          .dy = Read(*workspace_, output_.gradient),
                                          .y = Read(*workspace_, output_.values),
                                          .dx = Write(*workspace_, output_.gradient)});
  }
  workspace_->Add(ConvolutionWeights{.shape = shape_,
                                     .x = source_.map.values,
                                     .dy = output_.gradient,
                                     .weight_gradient = weight_.gradient,
                                     .bias_gradient = has_bias_ ? bias_.gradient : nullptr});
  if (source_.gradient == nullptr) return;
  workspace_->Add(ConvolutionData{.shape = shape_,
                                  .dy = output_.gradient,
                                  .weight = weight_.As(shape_.type),
                                  .dx = source_.gradient});
}

}  // namespace shoal::learner::device
