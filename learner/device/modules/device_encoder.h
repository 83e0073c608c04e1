// SPDX-License-Identifier: Apache-2.0
// An encoder of convolutions on a device. Maps are (B, h, w, C) with padded channels.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/nn/networks.h"
#include "learner/device/device_parameters.h"
#include "learner/device/modules/device_features.h"

namespace shoal::learner::device {

// Throws Error (kUsage) that names the configured encoder, `encoder`, unless the plan has pixels,
// then convolutions with ReLU or without activation, and at most a spatial softmax at the end.
void CheckEncoder(const nn::NetworkPlan& plan, const std::string& encoder);

class DeviceEncoder final : public nn::EncoderNetwork {
 public:
  // Attaches a mirror to the parameters.
  DeviceEncoder(Workspace* workspace, const nn::NetworkPlan& plan, nn::ParameterSet::Use use,
                nn::ParameterSet* parameters);

  const nn::Features& features() const override { return *features_; }
  void Refresh() override {}  // the mirror is sent when it is used
  void Forward(nn::Frames frames, nn::Statistics statistics) override;
  void Backward() override;

 private:
  struct Layer {
    ConvolutionShape shape;
    Tensor weight, bias;
    const void* source;  // map that the layer reads, and its gradient (null: none)
    void* source_gradient;
    void *output, *gradient;  // map; gradient: null in inference
    kernels::Activation activation;
    kernels::ColumnSums sums;  // over the map's pixels; not in inference
  };

  void Build(const nn::NetworkPlan& plan, const DeviceParameters& parameters, bool trained);
  void* NewMap(int64_t numbers) const;
  kernels::ColumnSums SumsOf(const ConvolutionShape& shape) const;
  void BackwardActivation(const Layer& layer);
  // Adds a spatial softmax of the last map.
  void AddPoints(const nn::LayerPlan& plan, bool trained);
  // Addresses of a map in the compute type, for kernels.
  kernels::Source Read(const void* map) const;
  kernels::Target Write(void* map) const;

  Workspace* const workspace_;
  nn::ParameterSet* const parameters_;
  const nn::LayerPlan pixels_;
  void* input_;                // (B, h, w, C) output of the pixels layer
  std::vector<Layer> layers_;  // convolutions
  // Spatial softmax: its launches; nullopt if there is none.
  struct Points {
    kernels::SpatialSoftmaxForward forward;
    kernels::SpatialSoftmaxBackward backward;
  };
  std::optional<Points> points_;
  std::optional<DeviceFeatures> features_;
};

}  // namespace shoal::learner::device
