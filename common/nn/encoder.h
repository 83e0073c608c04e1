// Frames to feature map: the layers of an encoder's plan (Eq. 2 of docs/algorithm.md).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "common/nn/conv.h"
#include "common/nn/layer_context.h"
#include "common/nn/network_plan.h"

namespace shoal::nn {

class Encoder {
 public:
  // The plan begins with its pixels; convolutions follow.
  Encoder(const LayerContext& context, const NetworkPlan& plan);

  // (B, N*h*w) row-major in the compute type; overwritten by every Forward.
  const dnnl::memory& features() const { return features_; }
  // dL/dfeatures, filled before Backward. Empty in inference.
  const dnnl::memory& features_gradient() const { return features_gradient_; }

  void Refresh();
  // frames (B, K*C, H, W) u8.
  void Forward(const uint8_t* frames);
  void Backward();

 private:
  void BuildFeatures(const LayerContext& context);

  int planes_, height_, width_, pool_;
  dnnl::memory input_;  // output of the pixels' layer, row-major in the compute type
  std::vector<std::unique_ptr<Conv>> convs_;
  Relayout flatten_;  // of the last convolution's output
  dnnl::memory features_, features_gradient_;
  Op unflatten_gradient_;
};

}  // namespace shoal::nn
