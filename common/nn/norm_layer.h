// SPDX-License-Identifier: Apache-2.0
// LayerNorm as a layer of its own: y = LN(x).
//
// Dimensions: B batch, O outputs, which are as many as the inputs.
#pragma once

#include "common/nn/hidden_layer.h"
#include "common/nn/network_plan.h"
#include "common/nn/row_norm.h"

namespace shoal::nn {

class NormLayer final : public HiddenLayer {
 public:
  // source: x (B, O). Backward writes dL/dx (B, O) to source_gradient. Both are f32 and borrowed.
  // output_precision: the type in which the next layer reads output().
  NormLayer(const LayerContext& context, const LayerPlan& plan, const dnnl::memory& source,
            const dnnl::memory& source_gradient, Precision output_precision);

  const Rows& output() const override { return output_; }
  Rows& output_gradient() override { return output_gradient_; }

  void Refresh() override {}
  void Forward() override;
  void Backward(Gradients wanted) override;

 private:
  const dnnl::memory source_, source_gradient_;
  Rows output_, output_gradient_;
  RowNorm norm_;
};

}  // namespace shoal::nn
