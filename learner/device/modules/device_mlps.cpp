// SPDX-License-Identifier: Apache-2.0
#include "learner/device/modules/device_mlps.h"

namespace shoal::learner::device {
namespace {

// Layer `i` of each plan.
std::vector<nn::LayerPlan> LayersAt(const std::vector<nn::NetworkPlan>& plans, size_t i) {
  std::vector<nn::LayerPlan> layers;
  for (const nn::NetworkPlan& plan : plans) layers.push_back(plan.layers()[i]);
  return layers;
}

}  // namespace

DeviceMlps::DeviceMlps(Workspace* workspace, const DeviceParameters& parameters,
                       const std::vector<nn::NetworkPlan>& plans, const float* input, bool trained)
    : count_(int(plans.size())) {
  const int64_t rows = int64_t(count_) * workspace->batch();
  const int width = plans[0].input().channels;
  if (trained) input_gradient_ = workspace->New<float>(rows * width);
  LayerSource source{.type = Type::kF32,
                     .values = input,
                     .columns = width,
                     .step = 0,
                     .gradient = input_gradient_,
                     .gradient_type = Type::kF32};
  const size_t layers = plans[0].layers().size();
  for (size_t i = 0; i < layers; ++i) {
    // The first layer and the output layer compute in f32, the layers between them in the compute
    // type.
    const bool next_is_inner = i + 2 < layers;
    const Type next = next_is_inner ? workspace->compute_type() : Type::kF32;
    layers_.push_back(std::make_unique<DenseLayer>(workspace, parameters, LayersAt(plans, i),
                                                   source, next == Type::kBf16, trained));
    const DenseLayer& layer = *layers_.back();
    if (i + 1 == layers) break;
    gradients_.push_back(trained ? workspace->New<float>(rows * layer.outputs()) : nullptr);
    source = {.type = next,
              .values = As(next, layer.output(), layer.rounded_output()),
              .columns = layer.outputs(),
              .step = layer.step(),
              .gradient = gradients_.back(),
              .gradient_type = Type::kF32};
  }
}

void DeviceMlps::Forward() {
  for (const auto& layer : layers_) layer->Forward();
}

void DeviceMlps::Backward(const float* output_gradient, const BackwardPart& part) {
  const float* gradient = output_gradient;
  for (size_t i = layers_.size(); i-- > 0;) {
    layers_[i]->Backward(gradient, {part.count, part.parameters, part.source || i > 0});
    if (i > 0) gradient = gradients_[i - 1];
  }
}

}  // namespace shoal::learner::device
