// SPDX-License-Identifier: Apache-2.0
#include "common/nn/latent_model_module.h"

#include <algorithm>
#include <functional>

#include "common/base/check.h"
#include "common/nn/dense_layer.h"
#include "common/nn/features.h"
#include "common/nn/host_memory.h"
#include "common/nn/linear.h"
#include "common/nn/mlp.h"
#include "common/nn/parallel.h"

namespace shoal::nn {
namespace {

// Copies columns first .. first + count - 1 of rows (B, columns).
void CopyColumns(const float* rows, int batch, int columns, int first, int count, float* out) {
  for (int b = 0; b < batch; ++b) {
    std::copy_n(rows + int64_t{b} * columns + first, count, out + int64_t{b} * count);
  }
}

}  // namespace

// The layers for one step, and their values and gradients.
struct LatentModelModule::Step {
  Step(const LatentModelPlan& plan, const LayerContext& context)
      : state_columns(plan.state_columns()),
        reward_columns(plan.reward_columns()),
        action(context.batch, plan.action.input().channels, Precision::kF32),
        action_gradient(context.batch, action.columns(), Precision::kF32),
        action_layer(context, plan.action.layers()[0], action.f32(), action_gradient.f32(),
                     Precision::kF32),
        input(context.batch, plan.joint.input().channels, Precision::kF32),
        joint(context, plan.joint, input),
        features(context.batch, plan.joint_columns(), Precision::kF32),
        features_gradient(context.batch, plan.joint_columns(), Precision::kF32),
        heads(context, plan.heads.layers()[0].name, features.f32(), features_gradient.f32()),
        end(size_t(context.batch)),
        state(size_t(context.batch) * size_t(state_columns)),
        reward(size_t(context.batch) * size_t(reward_columns)) {}

  int batch() const { return input.batch(); }

  void Refresh() {
    action_layer.Refresh();
    joint.Refresh();
    heads.Refresh();
  }

  void Join(const float* from, const float* with) {
    std::copy_n(with, action.size(), action.values());
    action.Commit();
    action_layer.Forward();
    input.SetColumns(0, state_columns, from);
    input.SetColumns(state_columns, action_layer.output().columns(),
                     action_layer.output().values());
    input.Commit();
    joint.Forward();
  }

  void Predict() {
    std::copy_n(joint.output(), features.size(), features.values());
    features.Commit();
    heads.Forward();
    const float* all = heads.output().values();
    CopyColumns(all, batch(), heads.outputs(), 0, 1, end.data());
    CopyColumns(all, batch(), heads.outputs(), 1, state_columns, state.data());
    CopyColumns(all, batch(), heads.outputs(), 1 + state_columns, reward_columns, reward.data());
  }

  // Computes the gradients of the joint layers' inputs, and of the parameters if they are wanted.
  void BackwardJoint(const float* gradient, bool parameters) {
    joint.Backward(gradient, {.parameters = parameters, .source = true});
    CopyColumns(joint.input_gradient(), batch(), input.columns(), state_columns,
                action_layer.output().columns(), action_layer.output_gradient().values());
    action_layer.Backward({.parameters = parameters, .source = !parameters});
  }

  // `later`: dL/dstate (B, Z) of the next step, added to that of the loss; null for the last step.
  void BackwardPrediction(const Prediction& loss, const float* later) {
    const std::span<const float> own_end = HostValues(loss.end), own_state = HostValues(loss.state),
                                 own_reward = HostValues(loss.reward);
    float* gradient = heads.output_gradient().values();
    for (int b = 0; b < batch(); ++b) {
      float* row = gradient + int64_t{b} * heads.outputs();
      const int64_t first = int64_t{b} * state_columns;
      row[0] = own_end[size_t(b)];
      for (int i = 0; i < state_columns; ++i) {
        row[1 + i] = own_state[size_t(first + i)] + (later == nullptr ? 0 : later[first + i]);
      }
      std::copy_n(own_reward.data() + int64_t{b} * reward_columns, reward_columns,
                  row + 1 + state_columns);
    }
    heads.Backward({.parameters = true, .source = true});
    BackwardJoint(features_gradient.values(), /*parameters=*/true);
  }

  void StateGradient(float* out) const {
    CopyColumns(joint.input_gradient(), batch(), input.columns(), 0, state_columns, out);
  }

  const int state_columns, reward_columns;
  Rows action, action_gradient;
  DenseLayer action_layer;
  Rows input;
  Mlp joint;
  Rows features, features_gradient;
  Linear heads;
  std::vector<float> end, state, reward;
};

LatentModelModule::LatentModelModule(const LatentModelPlan& plan, int steps, Use use,
                                     const ModuleContext& context)
    : Module(plan.Parameters(), use, context) {
  CHECK(context.maker == nullptr) << "latent models are computed on the CPU";
  const ThreadScope scope(context.threads);
  const LayerContext layers = ToLayerContext(&parameters_, use, context);
  if (steps == 0) join_ = std::make_unique<Step>(plan, layers);
  for (int h = 0; h < steps; ++h) steps_.push_back(std::make_unique<Step>(plan, layers));
}

LatentModelModule::~LatentModelModule() = default;

void LatentModelModule::Refresh() {
  const ThreadScope scope(context_.threads);
  if (join_) join_->Refresh();
  for (const auto& step : steps_) step->Refresh();
}

Array LatentModelModule::Join(Array state, Array action) {
  CHECK(join_) << "this copy unrolls";
  const ThreadScope scope(context_.threads);
  join_->Join(HostValues(state).data(), HostValues(action).data());
  return HostArray(std::span(join_->joint.output(), size_t(join_->features.size())));
}

void LatentModelModule::BackwardAction(Array joint_gradient, Array action_gradient) {
  const ThreadScope scope(context_.threads);
  join_->BackwardJoint(HostValues(joint_gradient).data(), /*parameters=*/false);
  std::copy_n(join_->action_gradient.values(), join_->action_gradient.size(),
              HostValues(action_gradient).data());
}

std::vector<LatentModelModule::Prediction> LatentModelModule::Unroll(
    Array state, std::span<const Array> actions) {
  CHECK(actions.size() <= steps_.size()) << actions.size() << " steps";
  const ThreadScope scope(context_.threads);
  std::vector<Prediction> predictions;
  const float* from = HostValues(state).data();
  for (size_t h = 0; h < actions.size(); ++h) {
    Step& step = *steps_[h];
    step.Join(from, HostValues(actions[h]).data());
    step.Predict();
    predictions.push_back({HostArray(step.end), HostArray(step.state), HostArray(step.reward)});
    from = step.state.data();
  }
  return predictions;
}

void LatentModelModule::BackwardUnroll(std::span<const Prediction> gradients,
                                       Array state_gradient) {
  CHECK(!gradients.empty() && gradients.size() <= steps_.size()) << gradients.size() << " steps";
  const ThreadScope scope(context_.threads);
  const auto size = size_t(parameters_.trained_size());
  float* own = parameters_.gradients();
  std::vector<float> later(size_t(state_gradient.size()));
  gradient_sums_.assign(size, 0.f);
  for (size_t h = gradients.size(); h-- > 0;) {
    const bool last = h + 1 == gradients.size();
    steps_[h]->BackwardPrediction(gradients[h], last ? nullptr : later.data());
    steps_[h]->StateGradient(later.data());
    std::transform(own, own + size, gradient_sums_.begin(), gradient_sums_.begin(), std::plus<>());
  }
  std::ranges::copy(gradient_sums_, own);
  std::ranges::copy(later, HostValues(state_gradient).begin());
}

}  // namespace shoal::nn
