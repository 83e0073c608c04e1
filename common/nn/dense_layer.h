// SPDX-License-Identifier: Apache-2.0
// Linear layer, optional LayerNorm, activation.
//
//   y = act(LN(weight x + bias))
//
// Dimensions: B batch, O outputs. xhat and rstd: see layer_norm.h.
#pragma once

#include <vector>

#include "common/nn/layer_context.h"
#include "common/nn/linear.h"
#include "common/nn/rows.h"

namespace shoal::nn {

class DenseLayer {
 public:
  // `plan`: a linear layer. source and source_gradient: see Linear. `output_precision` is the type
  // in which the next layer reads output().
  DenseLayer(const LayerContext& context, const LayerPlan& plan, const dnnl::memory& source,
             const dnnl::memory& source_gradient, Precision output_precision);

  const Rows& output() const { return linear_.output(); }
  // dL/dy (B, O) f32. The caller writes it before Backward, which overwrites it.
  Rows& output_gradient() { return linear_.output_gradient(); }

  void Refresh() { linear_.Refresh(); }
  void Forward();
  void Backward(Gradients wanted);

 private:
  // Its output and its gradient are those of the whole layer: normalisation and activation work in
  // place, because copies would cost more than the arithmetic.
  Linear linear_;
  Activation activation_;
  bool has_norm_;
  Parameter norm_weight_, norm_bias_;
  std::vector<float> normalised_;  // xhat (B, O)
  std::vector<float> scales_;      // rstd (B)
};

}  // namespace shoal::nn
