// SPDX-License-Identifier: Apache-2.0
// Maps in the memory of a device, and the base class of an encoder's layers, which read and write
// maps. A layer borrows the map that it reads.
//
// Dimensions: B batch, C channels with padding, (h, w) pixels of a map.
#pragma once

#include <cstdint>

#include "common/nn/module.h"
#include "common/nn/network_plan.h"
#include "learner/device/device_parameters.h"
#include "learner/device/workspace.h"

namespace shoal::learner::device {

// (B, h, w, C) in the compute type of the workspace.
struct DeviceMap {
  nn::MapShape shape = {};  // without padding
  int channels = 0;         // with padding
  void* values = nullptr;
  void* gradient = nullptr;  // dL/dvalues; null: there is none

  int64_t PixelNumbers() const { return int64_t{shape.height} * shape.width * channels; }
};

// A map that a layer reads, and where the layer writes the gradient of the map: `gradient` of the
// map, or an array that is added to it. Null: the gradient is not needed.
struct MapSource {
  DeviceMap map = {};
  void* gradient = nullptr;
};

// A new map; its gradient is null if `trained` is false.
DeviceMap NewMap(Workspace* workspace, const nn::MapShape& shape, bool trained);

// Addresses in the compute type of the workspace, for kernels. Null stays null.
kernels::Source Read(const Workspace& workspace, const void* values);
kernels::Target Write(const Workspace& workspace, void* values);

// Sums over the pixels of a map, for `sums` sums of each channel.
kernels::ColumnSums NewPixelSums(Workspace* workspace, const DeviceMap& map, int sums);

class DeviceMapLayer {
 public:
  virtual ~DeviceMapLayer() = default;
  DeviceMapLayer(const DeviceMapLayer&) = delete;
  DeviceMapLayer& operator=(const DeviceMapLayer&) = delete;

  // The readers of the map write its gradient before Backward, which may overwrite it.
  const DeviceMap& output() const { return output_; }

  virtual void Forward(nn::Statistics statistics) = 0;
  // Computes the gradients of the parameters, and of the source if it is needed. Refers to the
  // latest Forward.
  virtual void Backward() = 0;

 protected:
  explicit DeviceMapLayer(Workspace* workspace) : workspace_(workspace) {}

  Workspace* const workspace_;
  DeviceMap output_;
};

}  // namespace shoal::learner::device
