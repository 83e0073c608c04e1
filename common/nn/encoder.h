// SPDX-License-Identifier: Apache-2.0
// The layers of an encoder's plan, which map frames to a feature map (Eq. 2 of docs/algorithm.md).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "common/nn/batch_norm.h"
#include "common/nn/map_layer.h"
#include "common/nn/network_plan.h"

namespace shoal::nn {

class Encoder {
 public:
  // The plan begins with a pixels layer; convolutions and pools follow.
  Encoder(const LayerContext& context, const NetworkPlan& plan);

  // (B, N*h*w) row-major in the compute type; overwritten by every Forward.
  const dnnl::memory& features() const { return features_; }
  // dL/dfeatures, which the caller writes before Backward. Empty in inference.
  const dnnl::memory& features_gradient() const { return features_gradient_; }

  void Refresh();
  // frames (B, K*C, H, W) u8. statistics: must be kRunning in inference.
  void Forward(const uint8_t* frames, Statistics statistics);
  // Backward pass of the latest Forward. With batch normalisation in the plan, its statistics must
  // have been kBatch.
  void Backward();

 private:
  // One layer of the plan. If other layers read the same source, `shared` says how the gradients
  // are summed: after the backward pass, this layer's share is added to the source's gradient.
  struct Stage {
    std::unique_ptr<MapLayer> layer;
    MapSource shared = {};  // values: the share; gradient: the sum
  };

  void Build(const LayerContext& context, const NetworkPlan& plan);
  // Memory from which layer `reader` reads the output of layer `read`, and to which it writes the
  // gradient of that output.
  MapSource SourceOf(const NetworkPlan& plan, int reader, int read, MapSource* shared);
  void BuildFeatures(const LayerContext& context);

  int planes_, height_, width_, pool_;
  float shift_;         // added to the scaled pixels
  dnnl::memory input_;  // output of the pixels' layer, row-major in the compute type
  std::vector<Stage> stages_;
  std::vector<MapSource> outputs_;  // of each layer of the plan
  Relayout flatten_;                // of the last layer's output
  dnnl::memory features_, features_gradient_;
  Op unflatten_gradient_;
};

}  // namespace shoal::nn
