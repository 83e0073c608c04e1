// SPDX-License-Identifier: Apache-2.0
#include "common/nn/conv.h"

#include "common/base/check.h"
#include "common/nn/map_arithmetic.h"
#include "common/nn/primitive_descs.h"

namespace shoal::nn {
namespace {

using dnnl::memory;

constexpr auto kConvolution = dnnl::algorithm::convolution_auto;

}  // namespace

Conv::Conv(const LayerContext& context, const LayerPlan& plan, const memory& source,
           const memory& source_gradient)
    : strides_{plan.stride, plan.stride},
      padding_{plan.padding, plan.padding},
      // Batch normalisation applies the activation itself.
      relu_(plan.activation == Activation::kRelu && plan.batch_norm.empty()),
      has_bias_(plan.bias),
      weight_(context.parameters->Find(plan.name + ".weight")) {
  CHECK(plan.activation == Activation::kRelu || plan.activation == Activation::kNone) << plan.name;
  const memory::dims dims = DimsOf(source);
  const memory::data_type type = TypeOf(source);
  const memory::dims weight_dims = weight_.shape();
  const MapShape& from = plan.input;
  CHECK(dims == memory::dims({context.batch, from.channels, from.height, from.width}))
      << plan.name << ": another source than planned";
  const memory::dims output_dims = {context.batch, plan.output.channels, plan.output.height,
                                    plan.output.width};
  if (has_bias_) {
    bias_ = context.parameters->Find(plan.name + ".bias");
    bias_values_ = memory(PlainF32({weight_dims[0]}), CpuEngine(), nullptr);
  }
  // Descriptions and arguments of a convolution without a bias are empty.
  const memory::desc bias_desc = has_bias_ ? bias_values_.get_desc() : memory::desc();

  const auto forward = DescribeForward<dnnl::convolution_forward>(
      relu_ ? AttributesWithRelu() : Attributes(), dnnl::prop_kind::forward_training, kConvolution,
      AnyLayout(dims, type), AnyLayout(weight_dims, type), bias_desc, AnyLayout(output_dims, type),
      strides_, padding_, padding_);
  output_ = MakeMemory(forward.dst_desc());
  forward_source_ = Relayout::Before(source, forward.src_desc(), context.scratchpad);
  forward_weight_ = LaidOutWeight(weight_, forward.weights_desc(), context.scratchpad);
  forward_ = Op(forward,
                {{DNNL_ARG_SRC, forward_source_.memory()},
                 {DNNL_ARG_WEIGHTS, forward_weight_.memory()},
                 {DNNL_ARG_BIAS, bias_values_},
                 {DNNL_ARG_DST, output_}},
                context.scratchpad);
  if (!context.training) return;
  output_gradient_ = MakeMemory(output_.get_desc());
  BuildBackwardWeights(context, source, forward);
  if (source_gradient) BuildBackwardData(context, source_gradient, forward);
}

void Conv::BuildBackwardWeights(const LayerContext& context, const memory& source,
                                const dnnl::convolution_forward::primitive_desc& forward) {
  const memory::dims weight_dims = weight_.shape();
  const memory::desc bias_desc = has_bias_ ? bias_values_.get_desc() : memory::desc();
  const auto backward = DescribeBackward<dnnl::convolution_backward_weights>(
      forward, kConvolution, AnyLayout(DimsOf(source), TypeOf(source)),
      AnyLayout(weight_dims, memory::data_type::f32), bias_desc,
      AnyLayout(DimsOf(output_), TypeOf(output_)), strides_, padding_, padding_);
  const memory weight_target(PlainF32(weight_dims), CpuEngine(), weight_.gradient());
  const memory bias_target =
      has_bias_ ? memory(bias_desc, CpuEngine(), bias_.gradient()) : memory();
  weights_source_ = Relayout::Before(source, backward.src_desc(), context.scratchpad);
  weights_output_gradient_ =
      Relayout::Before(output_gradient_, backward.diff_dst_desc(), context.scratchpad);
  weight_gradient_ =
      Relayout::After(backward.diff_weights_desc(), weight_target, context.scratchpad);
  backward_weights_ = Op(backward,
                         {{DNNL_ARG_SRC, weights_source_.memory()},
                          {DNNL_ARG_DIFF_DST, weights_output_gradient_.memory()},
                          {DNNL_ARG_DIFF_WEIGHTS, weight_gradient_.memory()},
                          {DNNL_ARG_DIFF_BIAS, bias_target}},
                         context.scratchpad);
}

void Conv::BuildBackwardData(const LayerContext& context, const memory& source_gradient,
                             const dnnl::convolution_forward::primitive_desc& forward) {
  has_source_gradient_ = true;
  const memory::data_type type = TypeOf(source_gradient);
  const auto backward = DescribeBackward<dnnl::convolution_backward_data>(
      forward, kConvolution, AnyLayout(DimsOf(source_gradient), type),
      AnyLayout(weight_.shape(), type), AnyLayout(DimsOf(output_), TypeOf(output_)), strides_,
      padding_, padding_);
  data_output_gradient_ =
      Relayout::Before(output_gradient_, backward.diff_dst_desc(), context.scratchpad);
  data_weight_ = LaidOutWeight(weight_, backward.weights_desc(), context.scratchpad);
  source_gradient_ = Relayout::After(backward.diff_src_desc(), source_gradient, context.scratchpad);
  backward_data_ = Op(backward,
                      {{DNNL_ARG_DIFF_DST, data_output_gradient_.memory()},
                       {DNNL_ARG_WEIGHTS, data_weight_.memory()},
                       {DNNL_ARG_DIFF_SRC, source_gradient_.memory()}},
                      context.scratchpad);
}

void Conv::Refresh() {
  if (has_bias_) bias_values_.set_data_handle(bias_.value());
  forward_weight_.Refresh();
  if (has_source_gradient_) data_weight_.Refresh();
}

void Conv::Forward(Statistics) {
  forward_source_.Run();
  forward_.Run();
}

void Conv::Backward() {
  if (relu_) MaskWhereZero(output_, output_gradient_);
  weights_source_.Run();
  weights_output_gradient_.Run();
  backward_weights_.Run();
  weight_gradient_.Run();
  if (!has_source_gradient_) return;
  data_output_gradient_.Run();
  backward_data_.Run();
  source_gradient_.Run();
}

}  // namespace shoal::nn
