// SPDX-License-Identifier: Apache-2.0
// Average pooling to a map of a given size from a source of any size, as PyTorch's
// AdaptiveAvgPool2d.
//
//   y[b, c, i, j] = mean of x[b, c, u, v] over floor(i H/h) <= u < ceil((i+1) H/h), v likewise
//
// Windows overlap if h does not divide H; a source smaller than the output is repeated.
// Shapes: source (B, C, H, W), output (B, C, h, w) row-major, in the compute type; sums are f32.
#pragma once

#include "common/nn/map_layer.h"

namespace shoal::nn {

class AveragePool final : public MapLayer {
 public:
  // source_gradient: has the source's description and is overwritten; may be empty.
  AveragePool(const LayerContext& context, const LayerPlan& plan, const dnnl::memory& source,
              const dnnl::memory& source_gradient);

  void Forward(Statistics statistics) override;
  void Backward() override;

 private:
  int planes_;  // B C
  MapShape from_, to_;
  Relayout source_, source_gradient_;  // row-major
  bool has_source_gradient_ = false;
};

}  // namespace shoal::nn
