// SPDX-License-Identifier: Apache-2.0
#include "learner/device/modules/device_encoder.h"

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/nn/device_memory.h"

namespace shoal::learner::device {
namespace {

using Kind = nn::LayerPlan::Kind;

bool IsConvolutionWithRelu(const nn::LayerPlan& layer, int previous) {
  return layer.kind == Kind::kConvolution && layer.batch_norm.empty() && layer.bias &&
         layer.activation == nn::Activation::kRelu && layer.source == previous;
}

bool IsComputed(const nn::NetworkPlan& plan) {
  const std::vector<nn::LayerPlan>& layers = plan.layers();
  if (layers.size() < 2 || layers[0].kind != Kind::kPixels) return false;
  for (int i = 1; i < int(layers.size()); ++i) {
    if (!IsConvolutionWithRelu(layers[size_t(i)], i - 1)) return false;
  }
  return true;
}

ParameterLayout LayoutOf(const Workspace& workspace, const nn::NetworkPlan& plan,
                         const nn::ParameterSet& set) {
  ParameterLayout layout(set);
  for (size_t i = 1; i < plan.layers().size(); ++i) {
    const nn::LayerPlan& layer = plan.layers()[i];
    const int filters = layer.output.channels, padded = workspace.PaddedChannels(filters);
    layout.Set(layer.name + ".weight",
               {.outer = filters,
                .padded_outer = padded,
                .channels = layer.input.channels,
                .padded_channels = workspace.PaddedChannels(layer.input.channels),
                .pixels = int64_t{layer.kernel} * layer.kernel});
    layout.Set(layer.name + ".bias", {.outer = filters, .padded_outer = padded});
  }
  return layout;
}

}  // namespace

void CheckEncoder(const nn::NetworkPlan& plan, const std::string& encoder) {
  if (IsComputed(plan)) return;
  throw UsageError(
      "network.encoder = {}: a device computes encoders of convolutions alone, expected compact | "
      "drq | mrq | nature",
      encoder);
}

DeviceEncoder::DeviceEncoder(Workspace* workspace, const nn::NetworkPlan& plan,
                             nn::ParameterSet::Use use, nn::ParameterSet* parameters)
    : workspace_(workspace), parameters_(parameters), pixels_(plan.layers().at(0)) {
  CHECK(IsComputed(plan));
  const DeviceParameters& mirror = DeviceParameters::Attach(
      workspace, LayoutOf(*workspace, plan, *parameters), use, *parameters);
  Build(plan, mirror, use == nn::ParameterSet::Use::kTraining);
}

void* DeviceEncoder::NewMap(int64_t numbers) const {
  return workspace_->New<uint8_t>(numbers * SizeOf(workspace_->compute_type()));
}

void DeviceEncoder::Build(const nn::NetworkPlan& plan, const DeviceParameters& parameters,
                          bool trained) {
  const auto numbers = [this](const nn::MapShape& map) {
    return int64_t{workspace_->batch()} * map.height * map.width *
           workspace_->PaddedChannels(map.channels);
  };
  input_ = NewMap(numbers(pixels_.output));
  const void* source = input_;
  void* source_gradient = nullptr;
  for (size_t i = 1; i < plan.layers().size(); ++i) {
    const nn::LayerPlan& layer = plan.layers()[i];
    const ConvolutionShape shape{.type = workspace_->compute_type(),
                                 .batch = workspace_->batch(),
                                 .height = layer.input.height,
                                 .width = layer.input.width,
                                 .channels = workspace_->PaddedChannels(layer.input.channels),
                                 .filters = workspace_->PaddedChannels(layer.output.channels),
                                 .kernel = layer.kernel,
                                 .stride = layer.stride,
                                 .padding = layer.padding,
                                 .output_height = layer.output.height,
                                 .output_width = layer.output.width};
    layers_.push_back({.shape = shape,
                       .weight = parameters.Find(layer.name + ".weight"),
                       .bias = parameters.Find(layer.name + ".bias"),
                       .source = source,
                       .source_gradient = source_gradient,
                       .output = NewMap(numbers(layer.output)),
                       .gradient = trained ? NewMap(numbers(layer.output)) : nullptr,
                       .sums = trained ? SumsOf(shape) : kernels::ColumnSums{}});
    source = layers_.back().output;
    source_gradient = layers_.back().gradient;
  }
  const nn::MapShape& map = plan.output();
  features_.emplace(workspace_->compute_type(), map, workspace_->PaddedChannels(map.channels),
                    source, source_gradient);
}

kernels::ColumnSums DeviceEncoder::SumsOf(const ConvolutionShape& shape) const {
  kernels::ColumnSums sums{.rows = int64_t{shape.batch} * shape.output_height * shape.output_width,
                           .columns = shape.filters};
  sums.partials = workspace_->New<float>(sums.PartialsSize());
  sums.finished = workspace_->New<int32_t>(sums.groups());
  return sums;
}

void DeviceEncoder::Forward(nn::Frames frames, nn::Statistics) {
  parameters_->UseMirror(/*changes=*/false);
  const bool f32 = workspace_->compute_type() == Type::kF32;
  const int pool = pixels_.kernel;
  workspace_->Add(
      kernels::PoolFrames{.in = nn::AddressOf(frames),
                          .out = {f32 ? static_cast<float*>(input_) : nullptr,
                                  f32 ? nullptr : static_cast<uint16_t*>(input_)},
                          .batch = workspace_->batch(),
                          .channels = pixels_.input.channels,
                          .height = pixels_.input.height,
                          .width = pixels_.input.width,
                          .pool = pool,
                          .out_channels = workspace_->PaddedChannels(pixels_.output.channels),
                          .factor = float(1 / (255.0 * pool * pool)),
                          .shift = pixels_.range == nn::PixelRange::kUnit ? 0.f : -0.5f});
  for (const Layer& layer : layers_) {
    workspace_->Add(ConvolutionForward{.shape = layer.shape,
                                       .x = layer.source,
                                       .weight = layer.weight.As(layer.shape.type),
                                       .bias = layer.bias.value,
                                       .relu = true,
                                       .y = layer.output});
  }
}

// Turns the gradient of the layer's output into that of the numbers before its ReLU, and computes
// the gradient of the bias.
void DeviceEncoder::BackwardRelu(const Layer& layer) {
  const bool f32 = layer.shape.type == Type::kF32;
  const auto source = [f32](const void* map) {
    return kernels::Source{f32 ? static_cast<const float*>(map) : nullptr,
                           f32 ? nullptr : static_cast<const uint16_t*>(map)};
  };
  workspace_->Add(
      kernels::ActivationBackward{.sums = layer.sums,
                                  .dy = source(layer.gradient),
                                  .y = source(layer.output),
                                  .activation = kernels::Activation::kRelu,
                                  .dx = {f32 ? static_cast<float*>(layer.gradient) : nullptr,
                                         f32 ? nullptr : static_cast<uint16_t*>(layer.gradient)},
                                  .dbias = layer.bias.gradient});
}

void DeviceEncoder::Backward() {
  for (size_t i = layers_.size(); i-- > 0;) {
    const Layer& layer = layers_[i];
    BackwardRelu(layer);
    workspace_->Add(ConvolutionWeights{.shape = layer.shape,
                                       .x = layer.source,
                                       .dy = layer.gradient,
                                       .weight_gradient = layer.weight.gradient});
    if (layer.source_gradient == nullptr) continue;
    workspace_->Add(ConvolutionData{.shape = layer.shape,
                                    .dy = layer.gradient,
                                    .weight = layer.weight.As(layer.shape.type),
                                    .dx = layer.source_gradient});
  }
}

}  // namespace shoal::learner::device
