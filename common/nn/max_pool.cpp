// SPDX-License-Identifier: Apache-2.0
#include "common/nn/max_pool.h"

#include "common/nn/primitive_descs.h"

namespace shoal::nn {
namespace {

using dnnl::memory;

constexpr auto kPooling = dnnl::algorithm::pooling_max;

}  // namespace

MaxPool::MaxPool(const LayerContext& context, const LayerPlan& plan, const memory& source,
                 const memory& source_gradient) {
  const PoolWindow window{.strides = {plan.stride, plan.stride},
                          .kernel = {plan.kernel, plan.kernel},
                          .padding = {plan.padding, plan.padding}};
  const memory::desc to = AnyLayout(
      {context.batch, plan.output.channels, plan.output.height, plan.output.width}, TypeOf(source));
  const auto forward = DescribePooling(
      context.training ? dnnl::prop_kind::forward_training : dnnl::prop_kind::forward_inference,
      kPooling, source.get_desc(), to, window);
  output_ = MakeMemory(forward.dst_desc());
  if (!context.training) {
    forward_ = Op(forward, {{DNNL_ARG_SRC, source}, {DNNL_ARG_DST, output_}}, context.scratchpad);
    return;
  }
  winners_ = MakeMemory(forward.workspace_desc());
  forward_ =
      Op(forward, {{DNNL_ARG_SRC, source}, {DNNL_ARG_DST, output_}, {DNNL_ARG_WORKSPACE, winners_}},
         context.scratchpad);
  output_gradient_ = MakeMemory(output_.get_desc());
  if (!source_gradient) return;
  has_source_gradient_ = true;
  const auto backward = DescribePoolingBackward(forward, kPooling, source_gradient.get_desc(),
                                                output_gradient_.get_desc(), window);
  backward_ = Op(backward,
                 {{DNNL_ARG_DIFF_DST, output_gradient_},
                  {DNNL_ARG_DIFF_SRC, source_gradient},
                  {DNNL_ARG_WORKSPACE, winners_}},
                 context.scratchpad);
}

void MaxPool::Forward(Statistics) { forward_.Run(); }

void MaxPool::Backward() {
  if (has_source_gradient_) backward_.Run();
}

}  // namespace shoal::nn
