// SPDX-License-Identifier: Apache-2.0
// Average pooling of a map of any size to a map of a given size. The result is the same as that of
// PyTorch's AdaptiveAvgPool2d.
//
//   y[b, c, i, j] = mean of x[b, c, u, v] over floor(i H/h) <= u < ceil((i+1) H/h), v likewise
//
// Windows overlap if h does not divide H. If the source is smaller than the output, values of the
// source are repeated.
// Shapes: source (B, C, H, W), output (B, C, h, w) row-major, in the compute type; sums are f32.
#pragma once

#include "common/nn/map_layer.h"

namespace shoal::nn {

class AveragePool final : public MapLayer {
 public:
  // source_gradient: same shape and layout as source; overwritten, not accumulated; empty if no
  // gradient is needed.
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
