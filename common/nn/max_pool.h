// SPDX-License-Identifier: Apache-2.0
// Max pooling; its gradient goes to the largest value of a window, the first of equal ones.
//
//   y[b, c, i, j] = max_{u,v} x[b, c, i*s+u-p, j*s+v-p]   over what lies within the map
#pragma once

#include "common/nn/map_layer.h"

namespace shoal::nn {

class MaxPool final : public MapLayer {
 public:
  // source (B, C, H, W); source_gradient: of the source's description, overwritten; may be empty.
  MaxPool(const LayerContext& context, const LayerPlan& plan, const dnnl::memory& source,
          const dnnl::memory& source_gradient);

  void Forward(Statistics statistics) override;
  void Backward() override;

 private:
  dnnl::memory winners_;  // where in its window each maximum lies, as oneDNN notes it
  Op forward_, backward_;
  bool has_source_gradient_ = false;
};

}  // namespace shoal::nn
