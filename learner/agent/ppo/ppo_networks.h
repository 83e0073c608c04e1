// SPDX-License-Identifier: Apache-2.0
// The policy and the value function of PPO: two networks, each with its own encoder if there are
// pixels, or one network with both outputs (ppo.networks).
//
//   separate   encoder -> actor: mean (A);   value.encoder -> value: 1 output
//   shared     encoder -> actor: mean (A) and 1 output for the value
//
// The policy's log deviation (A) is a parameter.
//
// Dimensions: B minibatch, K frames of a stack, (C, H, W) of a frame, V vector size, A actions.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/config/config.h"
#include "common/nn/critic_module.h"
#include "common/nn/encoder_module.h"
#include "common/nn/parameter_set.h"
#include "common/nn/safetensors.h"
#include "common/spec/observation_spec.h"
#include "learner/agent/agent_state.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

// Only one thread may use an object, under a ThreadScope with the engine's number of threads.
// Borrows the engine.
class PpoNetworks {
 public:
  // Initialises the networks from config.seed.
  PpoNetworks(const Config& config, const ObservationSpec& spec, Engine* engine);

  // Computes mean and value. frames: (B, K*C, H, W), not read without pixels; vector: (B, V),
  // normalised.
  void Forward(Frames frames, Array vector);
  // Computes only the value; a shared network also computes the mean.
  void ForwardValue(Frames frames, Array vector);
  Array mean() const;                                // (B, A) of the latest Forward
  Array value() const;                               // (B) of the latest Forward or ForwardValue
  nn::ParameterSet* log_std() { return &log_std_; }  // (A)

  // Computes the gradients of all parameters except the log deviation for the latest Forward, from
  // the gradients of mean (B, A) and value (B).
  void Backward(Array mean_gradient, Array value_gradient);

  // Parameter sets that one optimiser steps, and the modules that a step changes.
  std::vector<nn::ParameterSet*> Sets();
  std::vector<nn::Module*> Modules();
  void AddTo(AgentState* state);
  // Encoder and actor, with the names that nn::Policy::Load reads.
  nn::TensorMap PolicyTensors() const;

 private:
  // An encoder, if there are pixels, and the head above it.
  struct Network {
    Network(const Config& config, const ObservationSpec& spec, const nn::ModuleContext& context,
            const std::string& encoder_name, const nn::HeadPlan& plan);
    void Forward(Frames frames, Array vector, nn::Statistics statistics);
    void Backward(Array gradient);

    std::unique_ptr<nn::EncoderModule> encoder;  // null without pixels
    nn::CriticModule head;                       // function of the observation alone
  };

  // Splits the columns of a shared network's outputs.
  void SplitShared() { engine_->SplitColumns(actor_.head.q(0), shared_mean_, shared_value_); }

  Engine* const engine_;
  const int action_size_;
  Network actor_;
  std::unique_ptr<Network> own_value_;  // null for a shared network
  nn::ParameterSet log_std_;
  // Only a shared network has these: (B, A), (B), (B, A + 1).
  Array shared_mean_, shared_value_, shared_gradient_;
};

}  // namespace shoal::learner
