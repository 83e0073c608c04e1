// Every network and optimiser of the agent: its whole state but the update counter.
//
//   critic set:   encoder.*, critic.*     trained by the critic's loss
//   actor set:    actor.*                 trained by the actor's loss on detached features
//   target set:   target.*                follows critic.*; there is no target encoder
//   temperature:  temperature.log {1}
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/config/config.h"
#include "common/nn/actor_head.h"
#include "common/nn/adam.h"
#include "common/nn/critic_heads.h"
#include "common/nn/encoder.h"
#include "common/nn/parameter_set.h"
#include "common/nn/precision.h"
#include "common/nn/safetensors.h"
#include "common/spec/observation_spec.h"

namespace shoal::learner {

// Built for one batch size. One thread at a time, under a ThreadScope of the size it was built in.
class SacNetworks {
 public:
  SacNetworks(const Config& config, const ObservationSpec& spec, nn::Precision precision);

  nn::ParameterSet critic_parameters, actor_parameters, target_parameters, temperature_parameters;
  nn::Adam critic_optimiser, actor_optimiser, temperature_optimiser;

  std::optional<nn::Encoder> encoder;  // empty without pixels
  std::optional<nn::CriticHeads> critic, target;
  std::optional<nn::ActorHead> actor;

  float Temperature() const;
  // Gradient of log temperature, for its optimiser.
  void StepTemperature(float gradient);

  // Each of these follows a change of the named set's values.
  void RefreshCritic();
  void RefreshActor() { actor->Refresh(); }
  void RefreshTarget() { target->Refresh(); }

  // target += tau * (critic - target), heads and trunk.
  void MoveTarget(float tau);

  nn::TensorMap PolicyTensors() const;
  nn::TensorMap AllTensors() const;
  // Throws Error naming a missing tensor or a wrong shape; then nothing has changed.
  void Restore(const nn::TensorMap& tensors, const std::string& source);

 private:
  // Throws Error half-way.
  void Import(const nn::TensorMap& tensors, const std::string& source);

  int64_t critic_heads_offset_;  // of critic.* in the critic set; target.* has the same layout
};

}  // namespace shoal::learner
