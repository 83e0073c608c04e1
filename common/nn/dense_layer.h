// SPDX-License-Identifier: Apache-2.0
// Linear layer, optional LayerNorm or sum with another layer's output, optional activation.
//
//   y = act(LN(weight x + bias))   or   y = act(weight x + bias + skip)
//
// Dimensions: B batch, O outputs.
#pragma once

#include <optional>

#include "common/nn/hidden_layer.h"
#include "common/nn/linear.h"
#include "common/nn/row_norm.h"

namespace shoal::nn {

class DenseLayer final : public HiddenLayer {
 public:
  // `plan`: a linear layer. source and source_gradient: see Linear. `output_precision` is the type
  // in which the next layer reads output(). `skip` (B, O): output that is added; borrowed, or null.
  // After Backward, output_gradient() is the gradient of this sum.
  DenseLayer(const LayerContext& context, const LayerPlan& plan, const dnnl::memory& source,
             const dnnl::memory& source_gradient, Precision output_precision,
             const Rows* skip = nullptr);

  const Rows& output() const override { return linear_.output(); }
  Rows& output_gradient() override { return linear_.output_gradient(); }

  void Refresh() override { linear_.Refresh(); }
  void Forward() override;
  void Backward(Gradients wanted) override;

 private:
  // Its output and its gradient are those of the whole layer: normalisation and activation work in
  // place, because copies would cost more than the arithmetic.
  Linear linear_;
  const Rows* skip_;
  Activation activation_;
  std::optional<RowNorm> norm_;
};

}  // namespace shoal::nn
