// SPDX-License-Identifier: Apache-2.0
#include "learner/device/modules/device_batch_norm.h"

#include <string>
#include <string_view>

#include "common/base/check.h"
#include "learner/device/modules/dense_layer.h"

namespace shoal::learner::device {
namespace {

std::string RunningName(const nn::LayerPlan& plan, std::string_view ending) {
  return plan.batch_norm + std::string(ending);
}

}  // namespace

DeviceBatchNorm::DeviceBatchNorm(Workspace* workspace, const nn::LayerPlan& plan,
                                 const DeviceParameters& parameters, const DeviceMap& source,
                                 const MapSource& skip, bool trained)
    : DeviceMapLayer(workspace),
      source_(source),
      skip_(skip),
      activation_(ActivationOf(plan.activation)),
      weight_(parameters.Find(plan.batch_norm + ".weight")),
      bias_(parameters.Find(plan.batch_norm + ".bias")),
      running_mean_(parameters.Find(RunningName(plan, nn::kRunningMean))),
      running_variance_(parameters.Find(RunningName(plan, nn::kRunningVariance))),
      rows_(int64_t{workspace->batch()} * plan.output.height * plan.output.width) {
  CHECK(activation_ != kernels::Activation::kTanh) << plan.batch_norm;
  output_ = NewMap(workspace, plan.output, /*trained=*/false);
  if (!trained) return;
  CHECK(rows_ > 1) << "statistics of one value per channel";
  output_.gradient = source.gradient;
  mean_ = workspace->New<float>(output_.channels);
  variance_ = workspace->New<float>(output_.channels);
  sums_ = NewPixelSums(workspace, output_, 2);
}

void DeviceBatchNorm::SetLayout(const Workspace& workspace, const nn::LayerPlan& plan,
                                ParameterLayout* layout) {
  const int channels = plan.output.channels;
  const ParameterOrder order{.outer = channels, .padded_outer = workspace.PaddedChannels(channels)};
  for (const std::string& name :
       {plan.batch_norm + ".weight", plan.batch_norm + ".bias", RunningName(plan, nn::kRunningMean),
        RunningName(plan, nn::kRunningVariance)}) {
    layout->Set(name, order);
  }
}

void DeviceBatchNorm::MeasureBatch() {
  const kernels::Source x = Read(*workspace_, source_.values);
  const auto n = double(rows_);
  workspace_->Add(
      kernels::ChannelMeans{.sums = sums_, .x = x, .inverse = float(1 / n), .mean = mean_});
  workspace_->Add(kernels::ChannelVariances{.sums = sums_,
                                            .x = x,
                                            .inverse = float(1 / n),
                                            .unbiased = float(n / (n - 1)),
                                            .mean = mean_,
                                            .variance = variance_,
                                            .running_mean = running_mean_.value,
                                            .running_variance = running_variance_.value,
                                            .next_mean = running_mean_.next_value,
                                            .next_variance = running_variance_.next_value});
}

void DeviceBatchNorm::Forward(nn::Statistics statistics) {
  measured_ = statistics == nn::Statistics::kBatch;
  CHECK(!measured_ || mean_ != nullptr) << "a network for inference has running statistics alone";
  if (measured_) MeasureBatch();
  workspace_->Add(
      kernels::BatchNormForward{.work = {rows_, output_.channels},
                                .x = Read(*workspace_, source_.values),
                                .skip = Read(*workspace_, skip_.map.values),
                                .mean = measured_ ? mean_ : running_mean_.value,
                                .variance = measured_ ? variance_ : running_variance_.value,
                                .weight = weight_.value,
                                .bias = bias_.value,
                                .activation = activation_,
                                .y = Write(*workspace_, output_.values)});
}

void DeviceBatchNorm::Backward() {
  CHECK(measured_) << "the gradient of a pass by running statistics";
  const kernels::Source x = Read(*workspace_, source_.values);
  const kernels::Source y = Read(*workspace_, output_.values);
  const kernels::Source dy = Read(*workspace_, output_.gradient);
  workspace_->Add(kernels::BatchNormWeights{.sums = sums_,
                                            .x = x,
                                            .dy = dy,
                                            .y = y,
                                            .mean = mean_,
                                            .variance = variance_,
                                            .activation = activation_,
                                            .dweight = weight_.gradient,
                                            .dbias = bias_.gradient});
  workspace_->Add(kernels::BatchNormBackward{.work = {rows_, output_.channels},
                                             .x = x,
                                             .dy = dy,
                                             .y = y,
                                             .inverse = float(1 / double(rows_)),
                                             .mean = mean_,
                                             .variance = variance_,
                                             .weight = weight_.value,
                                             .dweight = weight_.gradient,
                                             .dbias = bias_.gradient,
                                             .activation = activation_,
                                             .dx = Write(*workspace_, source_.gradient),
                                             .dskip = Write(*workspace_, skip_.gradient)});
}

}  // namespace shoal::learner::device
