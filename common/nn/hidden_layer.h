// SPDX-License-Identifier: Apache-2.0
// Interface of a hidden layer of an MLP.
//
// Dimensions: B batch, O outputs.
#pragma once

#include "common/nn/layer_context.h"
#include "common/nn/rows.h"

namespace shoal::nn {

class HiddenLayer {
 public:
  virtual ~HiddenLayer() = default;

  // y (B, O).
  virtual const Rows& output() const = 0;
  // dL/dy (B, O) f32. The caller writes it before Backward, which may overwrite it.
  virtual Rows& output_gradient() = 0;

  // Reads the parameters anew.
  virtual void Refresh() = 0;
  virtual void Forward() = 0;
  virtual void Backward(Gradients wanted) = 0;
};

}  // namespace shoal::nn
