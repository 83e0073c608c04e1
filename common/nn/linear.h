// SPDX-License-Identifier: Apache-2.0
// Linear layer.
//
//   y[b, o] = sum_i weight[o, i] x[b, i] + bias[o]
//
// Dimensions: B batch, I inputs, O outputs.
#pragma once

#include <string>

#include "common/nn/laid_out_weight.h"
#include "common/nn/layer_context.h"
#include "common/nn/rows.h"

namespace shoal::nn {

class Linear {
 public:
  // Parameters: `name`.weight (O, I) and `name`.bias (O). source: x (B, I) row-major; the products
  // are computed in the type of the source. source_gradient: memory to which Backward writes dL/dx
  // (B, I); empty if no gradient is needed. output_precision: the type of output().compute(), which
  // the caller of Forward commits.
  Linear(const LayerContext& context, const std::string& name, const dnnl::memory& source,
         const dnnl::memory& source_gradient, Precision output_precision = Precision::kF32);

  int outputs() const { return output_.columns(); }
  // y (B, O). The caller may overwrite it after Forward: Backward does not read it.
  const Rows& output() const { return output_; }
  Rows& output() { return output_; }
  // dL/dy (B, O). The caller writes it before Backward.
  Rows& output_gradient() { return output_gradient_; }

  void Refresh();
  void Forward();
  void Backward(Gradients wanted);

 private:
  void BuildBackward(const LayerContext& context, const dnnl::memory& source,
                     const dnnl::memory& source_gradient,
                     const dnnl::inner_product_forward::primitive_desc& forward);

  Parameter weight_, bias_;
  dnnl::memory bias_values_;  // memory of the parameter's values
  Rows output_, output_gradient_;
  Relayout forward_source_;
  LaidOutWeight forward_weight_;
  Op forward_;
  Relayout backward_source_, weight_gradient_;
  Op backward_weights_;
  LaidOutWeight backward_weight_;
  Relayout source_gradient_;
  Op backward_data_;
  bool has_source_gradient_ = false;
};

}  // namespace shoal::nn
