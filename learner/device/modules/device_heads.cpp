// SPDX-License-Identifier: Apache-2.0
#include "learner/device/modules/device_heads.h"

#include "common/base/check.h"
#include "common/nn/device_memory.h"

namespace shoal::learner::device {
namespace {

using nn::AddressOf;
using Use = nn::ParameterSet::Use;

bool Trained(Use use) { return use == Use::kTraining; }

const DeviceParameters& AttachHead(Workspace* workspace, const nn::HeadPlan& plan,
                                   const DeviceFeatures* features, Use use,
                                   const nn::ParameterSet& set) {
  ParameterLayout layout(set);
  DeviceTrunk::SetLayout(plan, features, &layout);
  return DeviceParameters::Attach(workspace, layout, use, set);
}

// The plan of a linear layer that computes `outputs` functions of a trunk's outputs.
nn::LayerPlan ReadoutPlan(const std::string& name, int inputs, nn::ParameterSet* parameters) {
  const auto outputs = int(parameters->Find(name + ".bias").shape()[0]);
  return {.name = name, .key = "", .input = {inputs}, .output = {outputs}};
}

}  // namespace

DeviceCritic::DeviceCritic(Workspace* workspace, const nn::HeadPlan& plan,
                           const DeviceFeatures* features, bool trains_encoder, Use use,
                           nn::ParameterSet* parameters)
    : workspace_(workspace),
      parameters_(parameters),
      action_size_(plan.extra_columns),
      trunk_(workspace, AttachHead(workspace, plan, features, use, *parameters), plan, features,
             trains_encoder, Trained(use)),
      mlps_(workspace, DeviceParameters::Of(*parameters), plan.mlps, trunk_.input(), Trained(use)),
      q_gradients_(Trained(use) ? workspace->New<float>(mlps_.count() * mlps_.output_step())
                                : nullptr) {}

nn::Array DeviceCritic::q(int i) const {
  auto* values = const_cast<float*>(mlps_.output()) + i * mlps_.output_step();
  return nn::DeviceArray(values, mlps_.output_step());
}

void DeviceCritic::ForwardObservation(nn::Array vector) {
  parameters_->UseMirror(/*changes=*/false);
  trunk_.Forward(AddressOf(vector));
}

void DeviceCritic::ForwardAction(nn::Array action) {
  trunk_.FillInput(AddressOf(action));
  mlps_.Forward();
}

void DeviceCritic::JoinGradients(std::span<const nn::Array> q_gradients, int count) {
  const int64_t bytes = mlps_.output_step() * int64_t(sizeof(float));
  for (int i = 0; i < count; ++i) {
    float* to = q_gradients_ + i * mlps_.output_step();
    const float* from = AddressOf(q_gradients[size_t(i)]);
    if (from == nullptr) {
      workspace_->Add(Clear{.memory = to, .bytes = bytes});
    } else {
      workspace_->Add(Copy{.from = from, .to = to, .bytes = bytes});
    }
  }
}

void DeviceCritic::Backward(std::span<const nn::Array> q_gradients) {
  CHECK(int(q_gradients.size()) == count()) << q_gradients.size() << " gradients";
  JoinGradients(q_gradients, count());
  mlps_.Backward(q_gradients_, {.count = count(), .parameters = true, .source = true});
  trunk_.Backward(mlps_.input_gradient(), count());
}

void DeviceCritic::BackwardAction(std::span<const nn::Array> q_gradients,
                                  nn::Array action_gradient) {
  // Functions behind the last one that the loss uses have no gradient.
  int used = int(q_gradients.size());
  while (used > 0 && !q_gradients[size_t(used) - 1]) --used;
  CHECK(used > 0) << "no Q function is part of the loss";
  JoinGradients(q_gradients, used);
  mlps_.Backward(q_gradients_, {.count = used, .parameters = false, .source = true});
  workspace_->Add(kernels::SumColumns{.functions = used,
                                      .rows = workspace_->batch(),
                                      .columns = action_size_,
                                      .from = mlps_.input_gradient(),
                                      .from_width = trunk_.width(),
                                      .first = trunk_.extra_column(),
                                      .addend = nullptr,
                                      .to = {.f32 = AddressOf(action_gradient), .bf16 = nullptr}});
}

DeviceActor::DeviceActor(Workspace* workspace, const nn::ActorPlan& plan,
                         const DeviceFeatures* features, bool trains_encoder, Use use,
                         nn::ParameterSet* parameters)
    : workspace_(workspace),
      parameters_(parameters),
      gaussian_(plan.output == nn::ActorOutput::kGaussian),
      clamped_(plan.log_std == nn::LogStd::kClamped),
      action_size_(plan.action_size),
      trunk_(workspace, AttachHead(workspace, plan, features, use, *parameters), plan, features,
             trains_encoder, Trained(use)),
      mlp_(workspace, DeviceParameters::Of(*parameters), plan.mlps, trunk_.input(), Trained(use)),
      mean_(gaussian_ ? workspace->New<float>(numbers()) : const_cast<float*>(mlp_.output())),
      second_(workspace->New<float>(numbers())),
      output_gradient_(Trained(use) ? workspace->New<float>(mlp_.output_step()) : nullptr) {
  CHECK(plan.output != nn::ActorOutput::kUnsquashed);
}

nn::ActorArrays DeviceActor::Forward(nn::Array vector) {
  parameters_->UseMirror(/*changes=*/false);
  trunk_.Forward(AddressOf(vector));
  trunk_.FillInput(nullptr);
  mlp_.Forward();
  if (gaussian_) return ForwardGaussian();
  workspace_->Add(kernels::TanhHead{.n = numbers(), .mean = mean_, .action = second_});
  return {nn::DeviceArray(mean_, numbers()), {}, nn::DeviceArray(second_, numbers())};
}

nn::ActorArrays DeviceActor::ForwardGaussian() {
  workspace_->Add(kernels::GaussianHead{.rows = workspace_->batch(),
                                        .actions = action_size_,
                                        .clamped = clamped_,
                                        .output = mlp_.output(),
                                        .mean = mean_,
                                        .log_std = second_});
  return {nn::DeviceArray(mean_, numbers()), nn::DeviceArray(second_, numbers()), {}};
}

void DeviceActor::Backward(nn::Array mean_gradient, nn::Array log_std_gradient) {
  CHECK(gaussian_);
  workspace_->Add(
      kernels::GaussianHeadBackward{.rows = workspace_->batch(),
                                    .actions = action_size_,
                                    .clamped = clamped_,
                                    .output = mlp_.output(),
                                    .log_std = second_,
                                    .mean_gradient = AddressOf(mean_gradient),
                                    .log_std_gradient = AddressOf(log_std_gradient),
                                    .output_gradient = {.f32 = output_gradient_, .bf16 = nullptr}});
  BackwardMlp();
}

void DeviceActor::BackwardAction(nn::Array action_gradient, double mean_penalty) {
  CHECK(!gaussian_);
  workspace_->Add(
      kernels::TanhHeadBackward{.n = numbers(),
                                .penalty_slope = float(2 * mean_penalty / double(numbers())),
                                .mean = mean_,
                                .action = second_,
                                .action_gradient = AddressOf(action_gradient),
                                .mean_gradient = {.f32 = output_gradient_, .bf16 = nullptr}});
  BackwardMlp();
}

void DeviceActor::BackwardMlp() {
  mlp_.Backward(output_gradient_, {.count = 1, .parameters = true, .source = true});
  trunk_.Backward(mlp_.input_gradient(), 1);
}

DeviceReadout::DeviceReadout(Workspace* workspace, const std::string& name,
                             const DeviceFeatures& trunk, nn::ParameterSet* parameters)
    : parameters_(parameters),
      trunk_(trunk),
      linear_(workspace,
              DeviceParameters::Attach(workspace, ParameterLayout(*parameters), Use::kTraining,
                                       *parameters),
              {ReadoutPlan(name, trunk.columns(), parameters)},
              {.type = Type::kF32,
               .values = trunk.values(),
               .columns = trunk.columns(),
               .step = 0,
               .gradient = trunk.gradient(),
               .gradient_type = Type::kF32},
              /*rounds=*/false, /*trained=*/true) {}

nn::Array DeviceReadout::Forward() {
  parameters_->UseMirror(/*changes=*/false);
  linear_.Forward();
  return nn::DeviceArray(const_cast<float*>(linear_.output()), linear_.step());
}

void DeviceReadout::Backward(nn::Array gradient) {
  linear_.Backward(AddressOf(gradient), {.count = 1, .parameters = true, .source = true});
  trunk_.SetHasGradient(true);
}

}  // namespace shoal::learner::device
