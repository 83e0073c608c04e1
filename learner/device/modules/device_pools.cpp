// SPDX-License-Identifier: Apache-2.0
#include "learner/device/modules/device_pools.h"

#include <limits>

#include "common/base/check.h"

namespace shoal::learner::device {
namespace {

kernels::PoolShape PoolShapeOf(const Workspace& workspace, const nn::LayerPlan& plan,
                               const DeviceMap& from) {
  CHECK(workspace.batch() * from.PixelNumbers() <= std::numeric_limits<int>::max()) << plan.name;
  return {.batch = workspace.batch(),
          .channels = from.channels,
          .height = plan.input.height,
          .width = plan.input.width,
          .output_height = plan.output.height,
          .output_width = plan.output.width,
          .kernel = plan.kernel,
          .stride = plan.stride,
          .padding = plan.padding};
}

}  // namespace

DeviceMaxPool::DeviceMaxPool(Workspace* workspace, const nn::LayerPlan& plan,
                             const MapSource& source, bool trained)
    : DeviceMapLayer(workspace),
      source_(source),
      shape_(PoolShapeOf(*workspace, plan, source.map)) {
  CHECK(plan.kernel <= kernels::MaxPoolForward::kMostKernel) << plan.name;
  output_ = NewMap(workspace, plan.output, trained);
  if (trained) winners_ = workspace->New<uint8_t>(shape_.outputs());
}

void DeviceMaxPool::Forward(nn::Statistics) {
  workspace_->Add(kernels::MaxPoolForward{.shape = shape_,
                                          .x = Read(*workspace_, source_.map.values),
                                          .y = Write(*workspace_, output_.values),
                                          .winners = winners_});
}

void DeviceMaxPool::Backward() {
  if (source_.gradient == nullptr) return;
  workspace_->Add(kernels::MaxPoolBackward{.shape = shape_,
                                           .winners = winners_,
                                           .dy = Read(*workspace_, output_.gradient),
                                           .dx = Write(*workspace_, source_.gradient)});
}

DeviceAveragePool::DeviceAveragePool(Workspace* workspace, const nn::LayerPlan& plan,
                                     const MapSource& source, bool trained)
    : DeviceMapLayer(workspace),
      source_(source),
      shape_(PoolShapeOf(*workspace, plan, source.map)) {
  output_ = NewMap(workspace, plan.output, trained);
}

void DeviceAveragePool::Forward(nn::Statistics) {
  workspace_->Add(kernels::AveragePoolForward{.shape = shape_,
                                              .x = Read(*workspace_, source_.map.values),
                                              .y = Write(*workspace_, output_.values)});
}

void DeviceAveragePool::Backward() {
  if (source_.gradient == nullptr) return;
  workspace_->Add(kernels::AveragePoolBackward{.shape = shape_,
                                               .dy = Read(*workspace_, output_.gradient),
                                               .dx = Write(*workspace_, source_.gradient)});
}

DeviceSpatialSoftmax::DeviceSpatialSoftmax(Workspace* workspace, const nn::LayerPlan& plan,
                                           const MapSource& source, bool trained)
    : DeviceMapLayer(workspace), source_(source) {
  const kernels::PointsShape shape{.batch = workspace->batch(),
                                   .height = plan.input.height,
                                   .width = plan.input.width,
                                   .channels = plan.input.channels,
                                   .padded = source.map.channels,
                                   .sharpness = float(plan.sharpness)};
  const int64_t channels = int64_t{shape.batch} * shape.padded;
  const bool rounds = workspace->compute_type() == Type::kBf16;
  auto* const points = workspace->New<float>(2 * channels);
  auto* const rounded = rounds ? workspace->New<uint16_t>(2 * channels) : nullptr;
  output_ = {.shape = plan.output,
             .channels = shape.padded,
             .values = rounds ? static_cast<void*>(rounded) : points};
  if (trained) {
    output_.gradient = workspace->New<uint8_t>(2 * channels * SizeOf(workspace->compute_type()));
  }
  forward_ = {.shape = shape,
              .x = Read(*workspace, source.map.values),
              .points = {.f32 = points, .bf16 = rounded},
              .largest = workspace->New<float>(channels),
              .total = workspace->New<float>(channels)};
}

void DeviceSpatialSoftmax::Forward(nn::Statistics) { workspace_->Add(forward_); }

void DeviceSpatialSoftmax::Backward() {
  if (source_.gradient == nullptr) return;
  workspace_->Add(kernels::SpatialSoftmaxBackward{.shape = forward_.shape,
                                                  .x = forward_.x,
                                                  .points = forward_.points.f32,
                                                  .largest = forward_.largest,
                                                  .total = forward_.total,
                                                  .dpoints = Read(*workspace_, output_.gradient),
                                                  .dx = Write(*workspace_, source_.gradient)});
}

}  // namespace shoal::learner::device
