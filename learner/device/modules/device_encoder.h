// SPDX-License-Identifier: Apache-2.0
// The layers of an encoder's plan on a device. Maps are (B, h, w, C) with padded channels.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/nn/networks.h"
#include "learner/device/modules/device_features.h"
#include "learner/device/modules/device_map_layer.h"

namespace shoal::learner::device {

class DeviceEncoder final : public nn::EncoderNetwork {
 public:
  // The plan begins with a pixels layer; convolutions, pools and a spatial softmax follow. Attaches
  // a mirror to the parameters.
  DeviceEncoder(Workspace* workspace, const nn::NetworkPlan& plan, nn::ParameterSet::Use use,
                nn::ParameterSet* parameters);

  const nn::Features& features() const override { return *features_; }
  void Refresh() override {}  // the mirror is sent when it is used
  // statistics: must be kRunning in inference.
  void Forward(nn::Frames frames, nn::Statistics statistics) override;
  void Backward() override;

 private:
  // A layer. If several layers read one map, the last of them overwrites the map's gradient. Each
  // of the others writes its gradient to an array of its own, `own`, which is then added.
  struct Stage {
    std::unique_ptr<DeviceMapLayer> layer;
    DeviceMap shared = {};  // the map, if the layer's gradient must be added
    void* own = nullptr;    // null: nothing is added
  };

  void AddLayer(const nn::NetworkPlan& plan, int index, const DeviceParameters& parameters,
                bool trained);
  // Layer `reader` reads the output of layer `read`. Sets `stage` if the gradients must be added.
  MapSource SourceOf(const nn::NetworkPlan& plan, int reader, int read, Stage* stage);
  std::unique_ptr<DeviceMapLayer> MakeLayer(const nn::LayerPlan& plan,
                                            const DeviceParameters& parameters,
                                            const MapSource& source, bool trained);

  Workspace* const workspace_;
  nn::ParameterSet* const parameters_;
  const nn::LayerPlan pixels_;
  std::vector<Stage> stages_;
  std::vector<DeviceMap> outputs_;  // of the plan's layers; the first one is that of the pixels
  std::optional<DeviceFeatures> features_;
};

}  // namespace shoal::learner::device
