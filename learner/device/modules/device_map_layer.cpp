// SPDX-License-Identifier: Apache-2.0
#include "learner/device/modules/device_map_layer.h"

namespace shoal::learner::device {

DeviceMap NewMap(Workspace* workspace, const nn::MapShape& shape, bool trained) {
  DeviceMap map{.shape = shape, .channels = workspace->PaddedChannels(shape.channels)};
  const int64_t bytes = workspace->batch() * map.PixelNumbers() * SizeOf(workspace->compute_type());
  map.values = workspace->New<uint8_t>(bytes);
  if (trained) map.gradient = workspace->New<uint8_t>(bytes);
  return map;
}

kernels::Source Read(const Workspace& workspace, const void* values) {
  if (workspace.compute_type() == Type::kF32) return {static_cast<const float*>(values), nullptr};
  return {nullptr, static_cast<const uint16_t*>(values)};
}

kernels::Target Write(const Workspace& workspace, void* values) {
  if (workspace.compute_type() == Type::kF32) return {static_cast<float*>(values), nullptr};
  return {nullptr, static_cast<uint16_t*>(values)};
}

kernels::ColumnSums NewPixelSums(Workspace* workspace, const DeviceMap& map, int sums) {
  kernels::ColumnSums result{
      .rows = int64_t{workspace->batch()} * map.shape.height * map.shape.width,
      .columns = map.channels};
  result.partials = workspace->New<float>(sums * result.PartialsSize());
  result.finished = workspace->New<int32_t>(result.groups());
  return result;
}

}  // namespace shoal::learner::device
