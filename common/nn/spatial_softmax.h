// SPDX-License-Identifier: Apache-2.0
// Spatial softmax: one point for each channel, near the largest values of the channel's map. The
// point is the mean of the pixels' coordinates, weighted by a softmax over the pixels' values
// (Levine et al. 2016, arXiv:1504.00702; Finn et al. 2016, arXiv:1509.06113).
//
//   p[b, c, i, j] = exp(s x[b, c, i, j]) / sum_{u,v} exp(s x[b, c, u, v])     s: the sharpness
//   y[b, c, 0] = sum_{i,j} p[b, c, i, j] (2 j / (W-1) - 1)                    to the right
//   y[b, c, 1] = sum_{i,j} p[b, c, i, j] (2 i / (H-1) - 1)                    down
//
// If a map is only one pixel wide or high, the coordinate in this direction is 0.
// Shapes: source (B, C, H, W), output (B, C, 1, 2) row-major, in the compute type; all internal
// values are f32. The forward pass reads the map twice; the backward pass reads it once and
// computes p again, which is cheaper than storing p.
#pragma once

#include <vector>

#include "common/nn/map_layer.h"

namespace shoal::nn {

class SpatialSoftmax final : public MapLayer {
 public:
  // source_gradient: same shape and layout as source; overwritten, not accumulated; empty if no
  // gradient is needed.
  SpatialSoftmax(const LayerContext& context, const LayerPlan& plan, const dnnl::memory& source,
                 const dnnl::memory& source_gradient);

  void Forward(Statistics statistics) override;
  void Backward() override;

 private:
  // T: float, or uint16_t for the bits of a bf16.
  template <class T>
  void ForwardMaps();
  template <class T>
  void BackwardMaps();

  const bool bf16_;
  const int images_, channels_, blocks_, pixels_;  // B, C, C in blocks of lanes, H W
  const float sharpness_;                          // s
  std::vector<float> across_, down_;               // coordinates of the pixels
  Relayout source_, source_gradient_;              // in blocks of channels
  // Maximum of s x, and sum of exp(s x - maximum), for each image, block and lane.
  std::vector<float> largest_, total_;
  Relayout points_, points_gradient_;  // y and dL/dy in f32
  bool has_source_gradient_ = false;
};

}  // namespace shoal::nn
