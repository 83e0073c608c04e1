// SPDX-License-Identifier: Apache-2.0
// Critics, actors and readouts on a device. Formulas: common/nn/critic_heads.h, actor_head.h and
// readout_module.h.
//
// Dimensions: C Q functions, B rows, A actions, V vector size.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/nn/networks.h"
#include "learner/device/modules/device_mlps.h"
#include "learner/device/modules/device_trunk.h"

namespace shoal::learner::device {

class DeviceCritic final : public nn::CriticNetwork {
 public:
  // Attaches a mirror to the parameters.
  DeviceCritic(Workspace* workspace, const nn::HeadPlan& plan, const DeviceFeatures* features,
               bool trains_encoder, nn::ParameterSet::Use use, nn::ParameterSet* parameters);

  int count() const override { return mlps_.count(); }
  nn::Array q(int i) const override;
  const nn::Features* trunk_features() const override { return trunk_.features(); }
  void Refresh() override {}
  void ForwardObservation(nn::Array vector) override;
  void ForwardAction(nn::Array action) override;
  void Backward(std::span<const nn::Array> q_gradients) override;
  void BackwardAction(std::span<const nn::Array> q_gradients, nn::Array action_gradient) override;

 private:
  // Copies the first `count` gradients to one array (C, B). An absent gradient becomes 0.
  void JoinGradients(std::span<const nn::Array> q_gradients, int count);

  Workspace* const workspace_;
  nn::ParameterSet* const parameters_;
  const int action_size_;
  DeviceTrunk trunk_;
  DeviceMlps mlps_;
  float* const q_gradients_;  // (C, B, outputs)
};

class DeviceActor final : public nn::ActorNetwork {
 public:
  // Attaches a mirror to the parameters. CHECKs that the plan's output is squashed.
  DeviceActor(Workspace* workspace, const nn::ActorPlan& plan, const DeviceFeatures* features,
              bool trains_encoder, nn::ParameterSet::Use use, nn::ParameterSet* parameters);

  const nn::Features* trunk_features() const override { return trunk_.features(); }
  void Refresh() override {}
  nn::ActorArrays Forward(nn::Array vector) override;
  void Backward(nn::Array mean_gradient, nn::Array log_std_gradient) override;
  void BackwardAction(nn::Array action_gradient, double mean_penalty) override;

 private:
  int64_t numbers() const { return int64_t{workspace_->batch()} * action_size_; }  // B A
  nn::ActorArrays ForwardGaussian();
  // Reads output_gradient_.
  void BackwardMlp();

  Workspace* const workspace_;
  nn::ParameterSet* const parameters_;
  const bool gaussian_, clamped_;
  const int action_size_;
  DeviceTrunk trunk_;
  DeviceMlps mlp_;
  float* const mean_;                 // (B, A); without a Gaussian, the output of the MLP
  float* const second_;               // (B, A): log deviation, or action
  float* output_gradient_ = nullptr;  // (B, 2A) or (B, A)
};

class DeviceReadout final : public nn::ReadoutNetwork {
 public:
  // Attaches a mirror to the parameters.
  DeviceReadout(Workspace* workspace, const std::string& name, const DeviceFeatures& trunk,
                nn::ParameterSet* parameters);

  void Refresh() override {}
  nn::Array Forward() override;
  void Backward(nn::Array gradient) override;

 private:
  nn::ParameterSet* const parameters_;
  const DeviceFeatures& trunk_;
  DenseLayer linear_;
};

}  // namespace shoal::learner::device
