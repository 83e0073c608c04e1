// SPDX-License-Identifier: Apache-2.0
#include "common/nn/linear.h"

#include "common/base/check.h"
#include "common/nn/primitive_descs.h"

namespace shoal::nn {
namespace {

using dnnl::memory;

// The precision whose compute type is the source's type.
Precision PrecisionOf(const memory& source) {
  return TypeOf(source) == memory::data_type::bf16 ? Precision::kBf16 : Precision::kF32;
}

}  // namespace

Linear::Linear(const LayerContext& context, const std::string& name, const memory& source,
               const memory& source_gradient, Precision output_precision)
    : weight_(context.parameters->Find(name + ".weight")),
      bias_(context.parameters->Find(name + ".bias")),
      output_(context.batch, int(bias_.shape()[0]), output_precision),
      output_gradient_(context.batch, outputs(), PrecisionOf(source)) {
  const memory::dims source_dims = DimsOf(source), weight_dims = weight_.shape();
  bias_values_ = memory(PlainF32({outputs()}), CpuEngine(), nullptr);
  CHECK(source_dims[1] == weight_dims[1])
      << name << ": source has " << source_dims[1] << " columns";

  const auto forward = DescribeForward<dnnl::inner_product_forward>(
      Attributes(), dnnl::prop_kind::forward_training, AnyLayout(source_dims, TypeOf(source)),
      AnyLayout(weight_dims, TypeOf(source)), bias_values_.get_desc(), output_.f32().get_desc());
  forward_source_ = Relayout::Before(source, forward.src_desc(), context.scratchpad);
  forward_weight_ = LaidOutWeight(weight_, forward.weights_desc(), context.scratchpad);
  forward_ = Op(forward,
                {{DNNL_ARG_SRC, forward_source_.memory()},
                 {DNNL_ARG_WEIGHTS, forward_weight_.memory()},
                 {DNNL_ARG_BIAS, bias_values_},
                 {DNNL_ARG_DST, output_.f32()}},
                context.scratchpad);
  if (context.training) BuildBackward(context, source, source_gradient, forward);
}

void Linear::BuildBackward(const LayerContext& context, const memory& source,
                           const memory& source_gradient,
                           const dnnl::inner_product_forward::primitive_desc& forward) {
  const memory& gradient = output_gradient_.compute();
  // Replicas have few rows, so copying whole gradients from another layout would take longer than
  // computing them. With one replica, the preferred layout keeps the results of earlier versions
  // bit for bit.
  const auto weights = DescribeBackward<dnnl::inner_product_backward_weights>(
      forward, AnyLayout(DimsOf(source), TypeOf(source)),
      context.plain_gradients ? PlainF32(weight_.shape())
                              : AnyLayout(weight_.shape(), memory::data_type::f32),
      bias_values_.get_desc(), gradient.get_desc());
  const memory weight_target(PlainF32(weight_.shape()), CpuEngine(), weight_.gradient());
  const memory bias_target(bias_values_.get_desc(), CpuEngine(), bias_.gradient());
  backward_source_ = Relayout::Before(source, weights.src_desc(), context.scratchpad);
  weight_gradient_ =
      Relayout::After(weights.diff_weights_desc(), weight_target, context.scratchpad);
  backward_weights_ = Op(weights,
                         {{DNNL_ARG_SRC, backward_source_.memory()},
                          {DNNL_ARG_DIFF_DST, gradient},
                          {DNNL_ARG_DIFF_WEIGHTS, weight_gradient_.memory()},
                          {DNNL_ARG_DIFF_BIAS, bias_target}},
                         context.scratchpad);
  if (!source_gradient) return;
  has_source_gradient_ = true;
  const auto data = DescribeBackward<dnnl::inner_product_backward_data>(
      forward, AnyLayout(DimsOf(source_gradient), TypeOf(source_gradient)),
      AnyLayout(weight_.shape(), TypeOf(source)), gradient.get_desc());
  backward_weight_ = LaidOutWeight(weight_, data.weights_desc(), context.scratchpad);
  source_gradient_ = Relayout::After(data.diff_src_desc(), source_gradient, context.scratchpad);
  backward_data_ = Op(data,
                      {{DNNL_ARG_DIFF_DST, gradient},
                       {DNNL_ARG_WEIGHTS, backward_weight_.memory()},
                       {DNNL_ARG_DIFF_SRC, source_gradient_.memory()}},
                      context.scratchpad);
}

void Linear::Refresh() {
  bias_values_.set_data_handle(bias_.value());
  forward_weight_.Refresh();
  if (has_source_gradient_) backward_weight_.Refresh();
}

void Linear::Forward() {
  forward_source_.Run();
  forward_.Run();
}

void Linear::Backward(Gradients wanted) {
  output_gradient_.Commit();
  if (wanted.parameters) {
    backward_source_.Run();
    backward_weights_.Run();
    weight_gradient_.Run();
  }
  if (wanted.source && has_source_gradient_) {
    backward_data_.Run();
    source_gradient_.Run();
  }
}

}  // namespace shoal::nn
