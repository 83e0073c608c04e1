// SPDX-License-Identifier: Apache-2.0
// The layers of an encoder's plan, which map frames to a feature map (Eq. 2 of docs/algorithm.md).
//
// Dimensions: B batch, K frames of a stack, (C, H, W) of a frame, (N, h, w) of the feature map.
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
  // frames: (B, K*C, H, W) u8. statistics: must be kRunning in inference.
  void Forward(const uint8_t* frames, Statistics statistics);
  // Backward pass of the latest Forward. If the plan has batch normalisation, the statistics of
  // that Forward must have been kBatch.
  void Backward();

 private:
  // One layer of the plan. If several layers read the same source, their gradients are summed.
  struct Stage {
    std::unique_ptr<MapLayer> layer;
    // Empty unless this layer's gradient must be added to the sum after the layer's backward pass.
    // values: gradient from this layer; gradient: the sum.
    MapSource shared = {};
  };

  void Build(const LayerContext& context, const NetworkPlan& plan);
  // Returns the memory from which layer `reader` reads the output of layer `read`, and the memory
  // to which `reader` writes the gradient of this output.
  MapSource SourceOf(const NetworkPlan& plan, int reader, int read, MapSource* shared);
  void BuildFeatures(const LayerContext& context);

  int planes_, height_, width_, pool_;
  float shift_;         // added to the scaled pixels
  dnnl::memory input_;  // output of the pixels layer, row-major in the compute type
  std::vector<Stage> stages_;
  std::vector<MapSource> outputs_;  // output and its gradient, for each layer of the plan
  Relayout flatten_;                // converts the last layer's output to row-major features_
  dnnl::memory features_, features_gradient_;
  Op unflatten_gradient_;
};

}  // namespace shoal::nn
