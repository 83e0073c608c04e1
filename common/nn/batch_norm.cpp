// SPDX-License-Identifier: Apache-2.0
#include "common/nn/batch_norm.h"

#include "common/base/check.h"
#include "common/nn/map_arithmetic.h"
#include "common/nn/primitive_descs.h"

namespace shoal::nn {
namespace {

using dnnl::memory;
using dnnl::normalization_flags;

constexpr float kEpsilon = 1e-5f, kMomentum = 0.1f;
const auto kAffine = normalization_flags::use_scale | normalization_flags::use_shift;

memory::desc PerChannel(const Parameter& parameter) { return PlainF32(parameter.shape()); }

}  // namespace

BatchNorm::BatchNorm(const LayerContext& context, const LayerPlan& plan, const MapSource& source,
                     const MapSource& skip)
    : relu_(plan.activation == Activation::kRelu),
      count_(int64_t{context.batch} * plan.output.height * plan.output.width),
      weight_(context.parameters->Find(plan.batch_norm + ".weight")),
      bias_(context.parameters->Find(plan.batch_norm + ".bias")),
      running_mean_(context.parameters->Find(plan.batch_norm + std::string(kRunningMean))),
      running_variance_(context.parameters->Find(plan.batch_norm + std::string(kRunningVariance))) {
  CHECK(relu_ || plan.activation == Activation::kNone) << plan.batch_norm;
  const memory::desc map = source.values.get_desc(), channels = PerChannel(weight_);
  CHECK(DimsOf(map) ==
        memory::dims({context.batch, plan.output.channels, plan.output.height, plan.output.width}))
      << plan.batch_norm << ": another source than planned";
  for (memory* values :
       {&weight_values_, &bias_values_, &running_mean_values_, &running_variance_values_}) {
    *values = memory(channels, CpuEngine(), nullptr);
  }
  output_ = MakeMemory(map);
  if (skip.values) skip_ = Relayout::Before(skip.values, map, context.scratchpad);
  const auto running = DescribeNormalization(dnnl::prop_kind::forward_inference, map, kEpsilon,
                                             kAffine | normalization_flags::use_global_stats);
  by_running_ = Op(running,
                   {{DNNL_ARG_SRC, source.values},
                    {DNNL_ARG_MEAN, running_mean_values_},
                    {DNNL_ARG_VARIANCE, running_variance_values_},
                    {DNNL_ARG_SCALE, weight_values_},
                    {DNNL_ARG_SHIFT, bias_values_},
                    {DNNL_ARG_DST, output_}},
                   context.scratchpad);
  if (context.training) BuildTraining(context, source, skip);
}

void BatchNorm::BuildTraining(const LayerContext& context, const MapSource& source,
                              const MapSource& skip) {
  CHECK(count_ > 1) << "statistics of one value per channel";
  const memory::desc map = output_.get_desc(), channels = PerChannel(weight_);
  mean_ = MakeMemory(channels);
  variance_ = MakeMemory(channels);
  const auto forward =
      DescribeNormalization(dnnl::prop_kind::forward_training, map, kEpsilon, kAffine);
  by_batch_ = Op(forward,
                 {{DNNL_ARG_SRC, source.values},
                  {DNNL_ARG_MEAN, mean_},
                  {DNNL_ARG_VARIANCE, variance_},
                  {DNNL_ARG_SCALE, weight_values_},
                  {DNNL_ARG_SHIFT, bias_values_},
                  {DNNL_ARG_DST, output_}},
                 context.scratchpad);
  output_gradient_ = MakeMemory(map);
  const auto backward = DescribeNormalizationBackward(forward, map, kEpsilon, kAffine);
  backward_ = Op(backward,
                 {{DNNL_ARG_SRC, source.values},
                  {DNNL_ARG_MEAN, mean_},
                  {DNNL_ARG_VARIANCE, variance_},
                  {DNNL_ARG_SCALE, weight_values_},
                  {DNNL_ARG_SHIFT, ShiftOfNormalizationBackward(bias_values_)},
                  {DNNL_ARG_DIFF_DST, output_gradient_},
                  {DNNL_ARG_DIFF_SRC, source.gradient},
                  {DNNL_ARG_DIFF_SCALE, memory(channels, CpuEngine(), weight_.gradient())},
                  {DNNL_ARG_DIFF_SHIFT, memory(channels, CpuEngine(), bias_.gradient())}},
                 context.scratchpad);
  has_skip_gradient_ = bool(skip.gradient);
  if (has_skip_gradient_) {
    skip_gradient_ = Op::Reorder(output_gradient_, skip.gradient, context.scratchpad);
  }
}

void BatchNorm::Refresh() {
  weight_values_.set_data_handle(weight_.value());
  bias_values_.set_data_handle(bias_.value());
  running_mean_values_.set_data_handle(running_mean_.value());
  running_variance_values_.set_data_handle(running_variance_.value());
}

void BatchNorm::MeasureRunning() {
  const auto* mean = static_cast<const float*>(mean_.get_data_handle());
  const auto* variance = static_cast<const float*>(variance_.get_data_handle());
  const float *former_mean = running_mean_.value(), *former_variance = running_variance_.value();
  float *next_mean = running_mean_.next_value(), *next_variance = running_variance_.next_value();
  // The running variance is the unbiased one, as in PyTorch.
  const float unbiased = float(double(count_) / double(count_ - 1));
  for (int64_t c = 0; c < weight_.shape()[0]; ++c) {
    next_mean[c] = (1 - kMomentum) * former_mean[c] + kMomentum * mean[c];
    next_variance[c] = (1 - kMomentum) * former_variance[c] + kMomentum * (variance[c] * unbiased);
  }
}

void BatchNorm::Forward(Statistics statistics) {
  measured_ = statistics == Statistics::kBatch;
  if (measured_) {
    CHECK(mean_) << "a network for inference has running statistics alone";
    by_batch_.Run();
    MeasureRunning();
  } else {
    by_running_.Run();
  }
  if (skip_.memory()) {
    skip_.Run();
    if (relu_) {
      AddThenRelu(skip_.memory(), output_);
    } else {
      Add(skip_.memory(), output_);
    }
  } else if (relu_) {
    Relu(output_);
  }
}

void BatchNorm::Backward() {
  CHECK(measured_) << "the gradient of a pass by running statistics";
  if (relu_) MaskWhereZero(output_, output_gradient_);
  if (has_skip_gradient_) skip_gradient_.Run();
  backward_.Run();
}

}  // namespace shoal::nn
