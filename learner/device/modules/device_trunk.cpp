// SPDX-License-Identifier: Apache-2.0
#include "learner/device/modules/device_trunk.h"

#include "common/base/check.h"

namespace shoal::learner::device {
namespace {

LayerSource SourceOf(const DeviceFeatures& features, bool trains_encoder) {
  return {.type = features.type(),
          .values = features.values(),
          .columns = features.padded_columns(),
          .step = 0,
          .gradient = trains_encoder ? features.gradient() : nullptr,
          .gradient_type = features.type()};
}

}  // namespace

DeviceTrunk::DeviceTrunk(Workspace* workspace, const DeviceParameters& parameters,
                         const nn::HeadPlan& plan, const DeviceFeatures* features,
                         bool trains_encoder, bool trained)
    : workspace_(workspace),
      features_(plan.trunk_columns()),
      vector_size_(plan.vector_columns),
      extra_size_(plan.extra_columns),
      width_(features_ + vector_size_ + extra_size_),
      input_(workspace->New<float>(int64_t(workspace->batch()) * width_)) {
  if (features_ == 0) return;
  CHECK(plan.trunk.layers().size() == 1 && features != nullptr);
  dense_.emplace(workspace, parameters, plan.trunk.layers(), SourceOf(*features, trains_encoder),
                 /*rounds=*/false, trained);
  float* readout_gradient = nullptr;
  if (trained) {
    gradient_ = workspace->New<float>(int64_t(workspace->batch()) * features_);
    readout_gradient = workspace->New<float>(int64_t(workspace->batch()) * features_);
  }
  own_features_.emplace(Type::kF32, nn::MapShape{features_}, features_, dense_->output(),
                        readout_gradient);
}

void DeviceTrunk::SetLayout(const nn::HeadPlan& plan, const DeviceFeatures* features,
                            ParameterLayout* layout) {
  if (plan.trunk_columns() == 0) return;
  CHECK(features != nullptr);
  const nn::MapShape& map = features->map();
  layout->Set(plan.trunk.layers()[0].name + ".weight",
              {.outer = plan.trunk_columns(),
               .padded_outer = plan.trunk_columns(),
               .channels = map.channels,
               .padded_channels = features->padded_channels(),
               .pixels = int64_t{map.height} * map.width});
}

void DeviceTrunk::Forward(const float* vector) {
  vector_ = vector;
  if (dense_) dense_->Forward();
}

void DeviceTrunk::FillInput(const float* extra) {
  kernels::CopyColumns copy;
  copy.rows = workspace_->batch();
  int column = 0;
  const auto add = [&](const float* from, int columns) {
    if (columns > 0) {
      copy.Add({.from = from,
                .from_width = columns,
                .first = 0,
                .count = columns,
                .to = {.f32 = input_, .bf16 = nullptr},
                .to_width = width_,
                .to_first = column});
    }
    column += columns;
  };
  add(dense_ ? dense_->output() : nullptr, features_);
  add(vector_, vector_size_);
  add(extra, extra_size_);
  workspace_->Add(copy);
}

void DeviceTrunk::Backward(const float* input_gradients, int count) {
  if (!dense_) return;
  const bool has_readout = own_features_->has_gradient();
  workspace_->Add(kernels::SumColumns{
      .functions = count,
      .rows = workspace_->batch(),
      .columns = features_,
      .from = input_gradients,
      .from_width = width_,
      .first = 0,
      .addend = has_readout ? static_cast<const float*>(own_features_->gradient()) : nullptr,
      .to = {.f32 = gradient_, .bf16 = nullptr}});
  own_features_->SetHasGradient(false);
  dense_->Backward(gradient_, {.count = 1, .parameters = true, .source = true});
}

}  // namespace shoal::learner::device
