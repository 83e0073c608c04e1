// SPDX-License-Identifier: Apache-2.0
// Max pooling. The gradient is added at the largest value of a window; of equal values, at the
// first.
//
//   y[b, c, i, j] = max_{u,v} x[b, c, i*s+u-p, j*s+v-p]   over the pixels within the map
#pragma once

#include "common/nn/map_layer.h"

namespace shoal::nn {

class MaxPool final : public MapLayer {
 public:
  // source (B, C, H, W); source_gradient: has the source's description and is overwritten; may be
  // empty.
  MaxPool(const LayerContext& context, const LayerPlan& plan, const dnnl::memory& source,
          const dnnl::memory& source_gradient);

  void Forward(Statistics statistics) override;
  void Backward() override;

 private:
  dnnl::memory winners_;  // position of each maximum in its window, in oneDNN's format
  Op forward_, backward_;
  bool has_source_gradient_ = false;
};

}  // namespace shoal::nn
