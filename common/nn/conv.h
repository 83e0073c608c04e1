// SPDX-License-Identifier: Apache-2.0
// Convolution, then ReLU if the plan has one and no batch normalisation precedes it.
//
//   y[b, n, i, j] = max(0, bias[n] + sum_{c,u,v} weight[n, c, u, v] x[b, c, i*s+u-p, j*s+v-p])
//
// with x = 0 outside of its map.
//
// Dimensions: B batch, C channels in, N filters, (H, W) in, (h, w) out, s stride, p padding; the
// plan defines all of them except B. oneDNN chooses the layouts in memory; neighbouring layers
// share them where it can.
#pragma once

#include "common/nn/laid_out_weight.h"
#include "common/nn/map_layer.h"

namespace shoal::nn {

class Conv final : public MapLayer {
 public:
  // source (B, C, H, W) in the compute type. `source_gradient` has the source's description; it is
  // empty if the gradient is not needed.
  Conv(const LayerContext& context, const LayerPlan& plan, const dnnl::memory& source,
       const dnnl::memory& source_gradient);

  void Refresh() override;
  void Forward(Statistics statistics) override;
  void Backward() override;

 private:
  void BuildBackwardWeights(const LayerContext& context, const dnnl::memory& source,
                            const dnnl::convolution_forward::primitive_desc& forward);
  void BuildBackwardData(const LayerContext& context, const dnnl::memory& source_gradient,
                         const dnnl::convolution_forward::primitive_desc& forward);

  dnnl::memory::dims strides_, padding_;
  bool relu_, has_bias_;
  Parameter weight_, bias_;
  dnnl::memory bias_values_;  // the parameter's array
  Relayout forward_source_;
  LaidOutWeight forward_weight_;
  Op forward_;
  Relayout weights_source_, weights_output_gradient_, weight_gradient_;
  Op backward_weights_;
  Relayout data_output_gradient_, source_gradient_;
  LaidOutWeight data_weight_;
  Op backward_data_;
  bool has_source_gradient_ = false;
};

}  // namespace shoal::nn
