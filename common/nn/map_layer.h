// SPDX-License-Identifier: Apache-2.0
// Base class of an encoder's layers, which read and write feature maps. A layer borrows the memory
// that it reads and owns the memory that it writes.
#pragma once

#include "common/nn/layer_context.h"
#include "common/nn/module.h"

namespace shoal::nn {

class MapLayer {
 public:
  virtual ~MapLayer() = default;
  MapLayer(const MapLayer&) = delete;
  MapLayer& operator=(const MapLayer&) = delete;

  // (B, C, h, w) in the compute type.
  const dnnl::memory& output() const { return output_; }
  // dL/doutput, with the same shape and layout as the output. The layer that reads the output
  // writes this gradient before Backward. Backward may overwrite the gradient. Empty in inference.
  const dnnl::memory& output_gradient() const { return output_gradient_; }

  virtual void Refresh() {}
  virtual void Forward(Statistics statistics) = 0;
  // Computes the gradients of the parameters, and of the source if the layer has memory for it.
  virtual void Backward() = 0;

 protected:
  MapLayer() = default;

  dnnl::memory output_, output_gradient_;
};

}  // namespace shoal::nn
