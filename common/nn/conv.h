// SPDX-License-Identifier: Apache-2.0
// Convolution, then ReLU if the plan has a ReLU and no batch normalisation. If the plan has both,
// BatchNorm computes the ReLU.
//
//   y[b, n, i, j] = max(0, bias[n] + sum_{c,u,v} weight[n, c, u, v] x[b, c, i*s+u-p, j*s+v-p])
//
// Outside of its map, x is 0.
//
// Dimensions: B batch, C channels in, N filters, (H, W) in, (h, w) out, s stride, p padding; the
// plan defines all of them except B. oneDNN chooses the layouts in memory, if possible the same
// layout for the output of one layer and the source of the next layer.
#pragma once

#include "common/nn/laid_out_weight.h"
#include "common/nn/map_layer.h"

namespace shoal::nn {

class Conv final : public MapLayer {
 public:
  // source: (B, C, H, W) in the compute type. source_gradient: same shape and layout as source;
  // overwritten, not accumulated; empty if no gradient is needed.
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
  dnnl::memory bias_values_;  // memory of the parameter's values
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
