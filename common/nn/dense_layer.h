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

  const Rows& output() const { return output_; }

  void Refresh() { linear_.Refresh(); }
  void Forward();
  // output_gradient: dL/dy (B, O).
  void Backward(const float* output_gradient, Gradients wanted);

 private:
  Linear linear_;
  Activation activation_;
  bool has_norm_;
  Parameter norm_weight_, norm_bias_;
  std::vector<float> normalised_;  // xhat (B, O)
  std::vector<float> scales_;      // rstd (B)
  Rows output_;
};

}  // namespace shoal::nn
