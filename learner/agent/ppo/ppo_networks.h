// SPDX-License-Identifier: Apache-2.0
// The policy and the value function of PPO: two networks, each with an encoder of its own where
// there are pixels, or one with both as outputs (ppo.networks).
//
//   separate   encoder -> actor: mean (A);   value.encoder -> value: V
//   shared     encoder -> actor: mean (A), V
//
// The policy's log deviation (A) is a parameter. Dimensions: B minibatch, A actions, V vector size.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "common/config/config.h"
#include "common/nn/critic_module.h"
#include "common/nn/encoder_module.h"
#include "common/nn/parameter_set.h"
#include "common/nn/safetensors.h"
#include "common/spec/observation_spec.h"
#include "learner/agent/agent_state.h"

namespace shoal::learner {

// One thread, under a ThreadScope of the context's threads.
class PpoNetworks {
 public:
  // Initialised from config.seed.
  PpoNetworks(const Config& config, const ObservationSpec& spec, const nn::ModuleContext& context);

  // frames (B, K*C, H, W), unread without pixels; vector (B, V), normalised.
  void Forward(nn::Frames frames, nn::Array vector);
  // The value alone; shared networks compute the policy, too.
  void ForwardValue(nn::Frames frames, nn::Array vector);
  std::span<const float> mean() const { return mean_; }    // (B, A) of the latest Forward
  std::span<const float> value() const { return value_; }  // (B) of the latest of both
  std::span<const float> log_std();                        // (A)

  // Destination of the loss's gradients: (B, A), (A), (B).
  std::span<float> mean_gradient() { return mean_gradient_; }
  std::span<float> log_std_gradient();
  std::span<float> value_gradient() { return value_gradient_; }
  // Gradients of all parameters from these, for the latest Forward.
  void Backward();

  // Parameter sets that one optimiser steps; call Refresh after each step.
  std::vector<nn::ParameterSet*> Sets();
  void Refresh();
  void AddTo(AgentState* state);
  // Encoder and actor as nn::Policy loads them.
  nn::TensorMap PolicyTensors() const;

 private:
  // An encoder, where there are pixels, and what stands above it.
  struct Network {
    Network(const Config& config, const ObservationSpec& spec, const nn::ModuleContext& context,
            const std::string& encoder_name, const nn::HeadPlan& plan);
    void Forward(nn::Frames frames, nn::Array vector, nn::Statistics statistics);
    void Backward(const std::vector<float>& gradient);

    std::unique_ptr<nn::EncoderModule> encoder;  // null without pixels
    nn::CriticModule head;                       // of the observation alone
  };

  void TakeValues(const Network& network, int outputs);

  const int batch_, action_size_;
  Network actor_;
  std::unique_ptr<Network> own_value_;  // null: shared
  nn::ParameterSet log_std_;
  std::vector<float> mean_, value_;                    // (B, A), (B)
  std::vector<float> mean_gradient_, value_gradient_;  // (B, A), (B)
};

}  // namespace shoal::learner
