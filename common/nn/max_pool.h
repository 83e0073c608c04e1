// SPDX-License-Identifier: Apache-2.0
// Max pooling. The gradient of a window goes to its largest value; of equal values, to the first.
//
//   y[b, c, i, j] = max_{u,v} x[b, c, i*s+u-p, j*s+v-p]   over the pixels within the map
#pragma once

#include "common/nn/map_layer.h"

namespace shoal::nn {

class MaxPool final : public MapLayer {
 public:
  // source: (B, C, H, W). source_gradient: same shape and layout as source; overwritten, not
  // accumulated; empty if no gradient is needed.
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
