// SPDX-License-Identifier: Apache-2.0
#include "learner/device/modules/device_encoder.h"

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/nn/device_memory.h"
#include "learner/device/modules/dense_layer.h"

namespace shoal::learner::device {
namespace {

using Kind = nn::LayerPlan::Kind;

bool IsPlainConvolution(const nn::LayerPlan& layer) {
  return layer.kind == Kind::kConvolution && layer.batch_norm.empty() && layer.bias &&
         layer.activation != nn::Activation::kTanh;
}

bool HasPoints(const nn::NetworkPlan& plan) {
  return plan.layers().back().kind == Kind::kSpatialSoftmax;
}

// Index of the last convolution.
size_t LastConvolution(const nn::NetworkPlan& plan) {
  return plan.layers().size() - (HasPoints(plan) ? 2 : 1);
}

bool IsComputed(const nn::NetworkPlan& plan) {
  const std::vector<nn::LayerPlan>& layers = plan.layers();
  if (layers.size() < (HasPoints(plan) ? 3u : 2u) || layers[0].kind != Kind::kPixels) return false;
  for (size_t i = 1; i < layers.size(); ++i) {
    if (layers[i].source != int(i) - 1) return false;
    if (i <= LastConvolution(plan) && !IsPlainConvolution(layers[i])) return false;
  }
  return true;
}

ParameterLayout LayoutOf(const Workspace& workspace, const nn::NetworkPlan& plan,
                         const nn::ParameterSet& set) {
  ParameterLayout layout(set);
  for (size_t i = 1; i <= LastConvolution(plan); ++i) {
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
      "network.encoder = {}: a device does not compute this encoder, expected compact | drq | "
      "mrq | nature | spatial_softmax",
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
  for (size_t i = 1; i <= LastConvolution(plan); ++i) {
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
                       .activation = ActivationOf(layer.activation),
                       .sums = trained ? SumsOf(shape) : kernels::ColumnSums{}});
    source = layers_.back().output;
    source_gradient = layers_.back().gradient;
  }
  if (HasPoints(plan)) {
    AddPoints(plan.layers().back(), trained);
    return;
  }
  const nn::MapShape& map = plan.output();
  features_.emplace(workspace_->compute_type(), map, workspace_->PaddedChannels(map.channels),
                    source, source_gradient);
}

void DeviceEncoder::AddPoints(const nn::LayerPlan& plan, bool trained) {
  const Layer& last = layers_.back();
  const kernels::PointsShape shape{.batch = workspace_->batch(),
                                   .height = plan.input.height,
                                   .width = plan.input.width,
                                   .channels = plan.input.channels,
                                   .padded = last.shape.filters,
                                   .sharpness = float(plan.sharpness)};
  const int64_t channels = int64_t{shape.batch} * shape.padded;
  auto* const points = workspace_->New<float>(2 * channels);
  const bool rounds = workspace_->compute_type() == Type::kBf16;
  auto* const rounded = rounds ? workspace_->New<uint16_t>(2 * channels) : nullptr;
  auto* const largest = workspace_->New<float>(channels);
  auto* const total = workspace_->New<float>(channels);
  void* const gradient = trained ? NewMap(2 * channels) : nullptr;
  points_ = {.forward = {.shape = shape,
                         .x = Read(last.output),
                         .points = {.f32 = points, .bf16 = rounded},
                         .largest = largest,
                         .total = total},
             .backward = {.shape = shape,
                          .x = Read(last.output),
                          .points = points,
                          .largest = largest,
                          .total = total,
                          .dpoints = Read(gradient),
                          .dx = Write(last.gradient)}};
  features_.emplace(workspace_->compute_type(), plan.output, shape.padded,
                    As(workspace_->compute_type(), points, rounded), gradient);
}

kernels::Source DeviceEncoder::Read(const void* map) const {
  const bool f32 = workspace_->compute_type() == Type::kF32;
  return {.f32 = f32 ? static_cast<const float*>(map) : nullptr,
          .bf16 = f32 ? nullptr : static_cast<const uint16_t*>(map)};
}

kernels::Target DeviceEncoder::Write(void* map) const {
  const bool f32 = workspace_->compute_type() == Type::kF32;
  return {.f32 = f32 ? static_cast<float*>(map) : nullptr,
          .bf16 = f32 ? nullptr : static_cast<uint16_t*>(map)};
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
  const int pool = pixels_.kernel;
  workspace_->Add(
      kernels::PoolFrames{.in = nn::AddressOf(frames),
                          .out = Write(input_),
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
                                       .relu = layer.activation == kernels::Activation::kRelu,
                                       .y = layer.output});
  }
  if (points_) workspace_->Add(points_->forward);
}

// Turns the gradient of the layer's output into that of the numbers before its activation, and
// computes the gradient of the bias.
void DeviceEncoder::BackwardActivation(const Layer& layer) {
  workspace_->Add(kernels::ActivationBackward{.sums = layer.sums,
                                              .dy = Read(layer.gradient),
                                              .y = Read(layer.output),
                                              .activation = layer.activation,
                                              .dx = Write(layer.gradient),
                                              .dbias = layer.bias.gradient});
}

void DeviceEncoder::Backward() {
  if (points_) workspace_->Add(points_->backward);
  for (size_t i = layers_.size(); i-- > 0;) {
    const Layer& layer = layers_[i];
    BackwardActivation(layer);
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
