// SPDX-License-Identifier: Apache-2.0
// Layers without parameters. Formulas: common/nn/network_plan.h, common/nn/average_pool.h,
// common/nn/spatial_softmax.h.
#pragma once

#include "learner/device/modules/device_map_layer.h"

namespace shoal::learner::device {

class DeviceMaxPool final : public DeviceMapLayer {
 public:
  DeviceMaxPool(Workspace* workspace, const nn::LayerPlan& plan, const MapSource& source,
                bool trained);

  void Forward(nn::Statistics statistics) override;
  void Backward() override;

 private:
  const MapSource source_;
  const kernels::PoolShape shape_;
  uint8_t* winners_ = nullptr;  // one for each number of the output; null in inference
};

class DeviceAveragePool final : public DeviceMapLayer {
 public:
  DeviceAveragePool(Workspace* workspace, const nn::LayerPlan& plan, const MapSource& source,
                    bool trained);

  void Forward(nn::Statistics statistics) override;
  void Backward() override;

 private:
  const MapSource source_;
  const kernels::PoolShape shape_;
};

// The output is a map of 1 x 2 pixels: all positions across, then all positions down.
class DeviceSpatialSoftmax final : public DeviceMapLayer {
 public:
  DeviceSpatialSoftmax(Workspace* workspace, const nn::LayerPlan& plan, const MapSource& source,
                       bool trained);

  void Forward(nn::Statistics statistics) override;
  void Backward() override;

 private:
  const MapSource source_;
  kernels::SpatialSoftmaxForward forward_;
};

}  // namespace shoal::learner::device
