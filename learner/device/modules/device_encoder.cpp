// SPDX-License-Identifier: Apache-2.0
#include "learner/device/modules/device_encoder.h"

#include "common/base/check.h"
#include "common/nn/device_memory.h"
#include "learner/device/modules/device_batch_norm.h"
#include "learner/device/modules/device_convolution.h"
#include "learner/device/modules/device_pools.h"

namespace shoal::learner::device {
namespace {

using Kind = nn::LayerPlan::Kind;

ParameterLayout LayoutOf(const Workspace& workspace, const nn::NetworkPlan& plan,
                         const nn::ParameterSet& set) {
  ParameterLayout layout(set);
  for (const nn::LayerPlan& layer : plan.layers()) {
    if (layer.kind != Kind::kConvolution) continue;
    DeviceConvolution::SetLayout(workspace, layer, &layout);
    if (!layer.batch_norm.empty()) DeviceBatchNorm::SetLayout(workspace, layer, &layout);
  }
  return layout;
}

}  // namespace

DeviceEncoder::DeviceEncoder(Workspace* workspace, const nn::NetworkPlan& plan,
                             nn::ParameterSet::Use use, nn::ParameterSet* parameters)
    : workspace_(workspace), parameters_(parameters), pixels_(plan.layers().at(0)) {
  CHECK(pixels_.kind == Kind::kPixels && plan.layers().size() > 1);
  const DeviceParameters& mirror = DeviceParameters::Attach(
      workspace, LayoutOf(*workspace, plan, *parameters), use, *parameters);
  const bool trained = use == nn::ParameterSet::Use::kTraining;
  outputs_.push_back(NewMap(workspace, pixels_.output, /*trained=*/false));
  for (int i = 1; i < int(plan.layers().size()); ++i) AddLayer(plan, i, mirror, trained);
  const DeviceMap& last = outputs_.back();
  features_.emplace(workspace->compute_type(), last.shape, last.channels, last.values,
                    last.gradient);
}

// Backward passes run from the last layer to the first.
MapSource DeviceEncoder::SourceOf(const nn::NetworkPlan& plan, int reader, int read, Stage* stage) {
  const DeviceMap& map = outputs_[size_t(read)];
  if (map.gradient == nullptr) return {map, nullptr};
  const std::vector<nn::LayerPlan>& layers = plan.layers();
  int last = reader;
  for (int i = reader; i < int(layers.size()); ++i) {
    if (layers[size_t(i)].source == read || layers[size_t(i)].skip == read) last = i;
  }
  if (last == reader) return {map, map.gradient};
  stage->shared = map;
  stage->own = workspace_->New<uint8_t>(workspace_->batch() * map.PixelNumbers() *
                                        SizeOf(workspace_->compute_type()));
  return {map, stage->own};
}

std::unique_ptr<DeviceMapLayer> DeviceEncoder::MakeLayer(const nn::LayerPlan& plan,
                                                         const DeviceParameters& parameters,
                                                         const MapSource& source, bool trained) {
  switch (plan.kind) {
    case Kind::kConvolution:
      return std::make_unique<DeviceConvolution>(workspace_, plan, parameters, source, trained);
    case Kind::kMaxPool:
      return std::make_unique<DeviceMaxPool>(workspace_, plan, source, trained);
    case Kind::kAveragePool:
      return std::make_unique<DeviceAveragePool>(workspace_, plan, source, trained);
    case Kind::kSpatialSoftmax:
      return std::make_unique<DeviceSpatialSoftmax>(workspace_, plan, source, trained);
    default:
      CHECK(false) << plan.name << " is no layer of maps";
  }
}

void DeviceEncoder::AddLayer(const nn::NetworkPlan& plan, int index,
                             const DeviceParameters& parameters, bool trained) {
  const nn::LayerPlan& layer = plan.layers()[size_t(index)];
  Stage stage;
  const MapSource source = SourceOf(plan, index, layer.source, &stage);
  stage.layer = MakeLayer(layer, parameters, source, trained);
  DeviceMap output = stage.layer->output();
  stages_.push_back(std::move(stage));
  if (!layer.batch_norm.empty()) {
    Stage norm;
    const MapSource skip =
        layer.skip == nn::kNoLayer ? MapSource() : SourceOf(plan, index, layer.skip, &norm);
    norm.layer =
        std::make_unique<DeviceBatchNorm>(workspace_, layer, parameters, output, skip, trained);
    output = norm.layer->output();
    stages_.push_back(std::move(norm));
  }
  outputs_.push_back(output);
}

void DeviceEncoder::Forward(nn::Frames frames, nn::Statistics statistics) {
  parameters_->UseMirror(/*changes=*/false);
  const int pool = pixels_.kernel;
  const DeviceMap& input = outputs_.front();
  workspace_->Add(
      kernels::PoolFrames{.in = nn::AddressOf(frames),
                          .out = Write(*workspace_, input.values),
                          .batch = workspace_->batch(),
                          .channels = pixels_.input.channels,
                          .height = pixels_.input.height,
                          .width = pixels_.input.width,
                          .pool = pool,
                          .out_channels = input.channels,
                          .factor = float(1 / (255.0 * pool * pool)),
                          .shift = pixels_.range == nn::PixelRange::kUnit ? 0.f : -0.5f});
  for (const Stage& stage : stages_) stage.layer->Forward(statistics);
}

void DeviceEncoder::Backward() {
  for (size_t i = stages_.size(); i-- > 0;) {
    const Stage& stage = stages_[i];
    stage.layer->Backward();
    if (stage.own == nullptr) continue;
    workspace_->Add(kernels::AddMap{.n = workspace_->batch() * stage.shared.PixelNumbers(),
                                    .addend = Read(*workspace_, stage.own),
                                    .before = Read(*workspace_, stage.shared.gradient),
                                    .sum = Write(*workspace_, stage.shared.gradient)});
  }
}

}  // namespace shoal::learner::device
