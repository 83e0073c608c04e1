// SPDX-License-Identifier: Apache-2.0
#include "learner/device/modules/dense_layer.h"

#include "common/base/check.h"

namespace shoal::learner::device {
namespace {

// Distance from function 0 to function 1, after a check that all functions have this distance.
int64_t StepOf(const std::vector<const float*>& addresses) {
  const int64_t step = addresses.size() > 1 ? addresses[1] - addresses[0] : 0;
  for (size_t i = 1; i < addresses.size(); ++i) CHECK(addresses[i] - addresses[i - 1] == step);
  return step;
}

}  // namespace

kernels::Activation ActivationOf(nn::Activation activation) {
  switch (activation) {
    case nn::Activation::kRelu:
      return kernels::Activation::kRelu;
    case nn::Activation::kTanh:
      return kernels::Activation::kTanh;
    case nn::Activation::kElu:
      return kernels::Activation::kElu;
    case nn::Activation::kNone:
      return kernels::Activation::kNone;
  }
  return kernels::Activation::kNone;
}

DenseLayer::DenseLayer(Workspace* workspace, const DeviceParameters& parameters,
                       const std::vector<nn::LayerPlan>& plans, const LayerSource& source,
                       bool rounds, bool trained)
    : workspace_(workspace),
      source_(source),
      activation_(plans[0].activation),
      has_norm_(plans[0].layer_norm),
      outputs_(plans[0].output.channels) {
  std::vector<const float*> weights, biases, norm_weights, norm_biases;
  for (const nn::LayerPlan& plan : plans) {
    Function function{
        parameters.Find(plan.name + ".weight"), parameters.Find(plan.name + ".bias"), {}, {}};
    if (has_norm_) {
      function.norm_weight = parameters.Find(plan.name + ".norm.weight");
      function.norm_bias = parameters.Find(plan.name + ".norm.bias");
      norm_weights.push_back(function.norm_weight.value);
      norm_biases.push_back(function.norm_bias.value);
    }
    functions_.push_back(function);
    weights.push_back(function.weight.value);
    biases.push_back(function.bias.value);
  }
  weight_step_ = StepOf(weights);
  bias_step_ = StepOf(biases);
  if (has_norm_) CHECK(StepOf(norm_weights) == bias_step_ && StepOf(norm_biases) == bias_step_);
  const auto count = int64_t(plans.size());
  const int64_t numbers = count * step();
  output_ = workspace->New<float>(numbers);
  if (rounds) rounded_ = workspace->New<uint16_t>(numbers);
  product_ = ProductIsOutput() ? output_ : workspace->New<float>(numbers);
  if (has_norm_) {
    normalised_ = workspace->New<float>(numbers);
    scales_ = workspace->New<float>(count * workspace->batch());
  }
  if (!trained) return;
  gradient_ = workspace->New<float>(numbers);
  if (source.type == Type::kBf16) rounded_gradient_ = workspace->New<uint16_t>(numbers);
  const kernels::ColumnSums sums = Sums(int(count));
  partials_ = workspace->New<float>(3 * sums.PartialsSize());
  counters_ = workspace->New<int32_t>(sums.groups());
}

bool DenseLayer::ProductIsOutput() const {
  return !has_norm_ && rounded_ == nullptr && activation_ != nn::Activation::kTanh &&
         activation_ != nn::Activation::kElu;
}

void DenseLayer::Forward() {
  const bool complete = ProductIsOutput();
  workspace_->Add(Product{.rows = workspace_->batch(),
                          .columns = outputs_,
                          .depth = source_.columns,
                          .input = source_.type,
                          .output = Type::kF32,
                          .a = source_.values,
                          .b = functions_[0].weight.As(source_.type),
                          .d = product_,
                          .a_stride = source_.columns,
                          .b_stride = source_.columns,
                          .d_stride = outputs_,
                          .b_transposed = true,
                          .bias = complete ? functions_[0].bias.value : nullptr,
                          .relu = complete && activation_ == nn::Activation::kRelu,
                          .count = int(functions_.size()),
                          .a_step = source_.step,
                          .b_step = weight_step_,
                          .d_step = step(),
                          .bias_step = complete ? bias_step_ : 0});
  if (complete) return;
  const Function& first = functions_[0];
  const kernels::Target y{output_, rounded_};
  if (!has_norm_) {
    workspace_->Add(kernels::BiasActivation{.functions = int(functions_.size()),
                                            .rows = workspace_->batch(),
                                            .step = bias_step_,
                                            .columns = outputs_,
                                            .x = {.f32 = product_, .bf16 = nullptr},
                                            .bias = first.bias.value,
                                            .activation = ActivationOf(activation_),
                                            .y = y});
    return;
  }
  workspace_->Add(kernels::LayerNormForward{.functions = int(functions_.size()),
                                            .rows = workspace_->batch(),
                                            .columns = outputs_,
                                            .step = bias_step_,
                                            .x = product_,
                                            .linear_bias = first.bias.value,
                                            .weight = first.norm_weight.value,
                                            .bias = first.norm_bias.value,
                                            .activation = ActivationOf(activation_),
                                            .xhat = normalised_,
                                            .rstd = scales_,
                                            .y = y});
}

void DenseLayer::Backward(const float* output_gradient, const BackwardPart& part) {
  OutputGradient(output_gradient, part);
  const void* gradient = As(source_.type, gradient_, rounded_gradient_);
  if (part.parameters) WeightGradients(part.count, gradient);
  if (part.source && source_.gradient != nullptr) SourceGradient(part.count, gradient);
}

kernels::ColumnSums DenseLayer::Sums(int count) const {
  return {.functions = count,
          .rows = workspace_->batch(),
          .columns = outputs_,
          .partials = partials_,
          .finished = counters_};
}

// Writes the gradient of weight x + bias, and the gradients of bias and norm.
void DenseLayer::OutputGradient(const float* output_gradient, const BackwardPart& part) {
  const Function& first = functions_[0];
  const kernels::Target dx{gradient_, rounded_gradient_};
  if (!has_norm_) {
    workspace_->Add(
        kernels::ActivationBackward{.sums = Sums(part.count),
                                    .step = bias_step_,
                                    .dy = {.f32 = output_gradient, .bf16 = nullptr},
                                    .y = {.f32 = output_, .bf16 = nullptr},
                                    .activation = ActivationOf(activation_),
                                    .dx = dx,
                                    .dbias = part.parameters ? first.bias.gradient : nullptr});
    return;
  }
  workspace_->Add(kernels::LayerNormBackward{.functions = part.count,
                                             .rows = workspace_->batch(),
                                             .columns = outputs_,
                                             .step = bias_step_,
                                             .dy = output_gradient,
                                             .y = output_,
                                             .activation = ActivationOf(activation_),
                                             .weight = first.norm_weight.value,
                                             .xhat = normalised_,
                                             .rstd = scales_,
                                             .dx = dx});
  if (!part.parameters) return;
  workspace_->Add(kernels::LayerNormBackwardWeights{.sums = Sums(part.count),
                                                    .step = bias_step_,
                                                    .dy = output_gradient,
                                                    .y = output_,
                                                    .xhat = normalised_,
                                                    .dx = {gradient_, nullptr},
                                                    .activation = ActivationOf(activation_),
                                                    .dweight = first.norm_weight.gradient,
                                                    .dbias = first.norm_bias.gradient,
                                                    .dlinear_bias = first.bias.gradient});
}

// dweight (O, I) = gradient^T x
void DenseLayer::WeightGradients(int count, const void* gradient) {
  workspace_->Add(Product{.rows = outputs_,
                          .columns = source_.columns,
                          .depth = workspace_->batch(),
                          .input = source_.type,
                          .output = Type::kF32,
                          .a = gradient,
                          .b = source_.values,
                          .d = functions_[0].weight.gradient,
                          .a_stride = outputs_,
                          .b_stride = source_.columns,
                          .d_stride = source_.columns,
                          .a_transposed = true,
                          .count = count,
                          .a_step = step(),
                          .b_step = source_.step,
                          .d_step = weight_step_});
}

// dx (B, I) = gradient weight
void DenseLayer::SourceGradient(int count, const void* gradient) {
  workspace_->Add(Product{.rows = workspace_->batch(),
                          .columns = source_.columns,
                          .depth = outputs_,
                          .input = source_.type,
                          .output = source_.gradient_type,
                          .a = gradient,
                          .b = functions_[0].weight.As(source_.type),
                          .d = source_.gradient,
                          .a_stride = outputs_,
                          .b_stride = source_.columns,
                          .d_stride = source_.columns,
                          .count = count,
                          .a_step = step(),
                          .b_step = weight_step_,
                          .d_step = int64_t(workspace_->batch()) * source_.columns});
}

}  // namespace shoal::learner::device
