// SPDX-License-Identifier: Apache-2.0
// One copy of the networks from observation to latent state, and of the model: the trained one, the
// one that the policy uses, or that of the targets.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/config/config.h"
#include "common/nn/encoder_module.h"
#include "common/nn/latent_model_module.h"
#include "common/nn/latent_state_module.h"
#include "common/spec/observation_spec.h"
#include "learner/agent/agent_state.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

// Names of the parameters: ENCODER.*, STATE.*, MODEL.* (nn/latent_plan.h).
struct LatentNames {
  std::string encoder, state, model;
};

// Not movable. One thread.
class LatentNetworks {
 public:
  // `horizon`: most steps of model().Unroll; 0 = the networks are not trained.
  LatentNetworks(const Config& config, const ObservationSpec& spec, const LatentNames& names,
                 int horizon, Engine* engine);
  LatentNetworks(const LatentNetworks&) = delete;
  LatentNetworks& operator=(const LatentNetworks&) = delete;

  // Returns the states (b, Z) of frames and vectors, valid until the next call.
  Array Encode(Frames frames, Array vector, nn::Statistics statistics);
  // Computes the gradients of the latest Encode from dL/dz (b, Z).
  void Backward(Array state_gradient);

  nn::LatentModelModule& model() { return model_; }
  // All modules, in the same order for every copy.
  std::vector<nn::Module*> Modules();
  std::vector<nn::ParameterSet*> Sets();
  // Encoder and state, the part of a policy.
  std::vector<const nn::ParameterSet*> PolicySets() const;

 private:
  const std::unique_ptr<nn::EncoderModule> encoder_;  // null without pixels
  nn::LatentStateModule state_;
  nn::LatentModelModule model_;
};

// Z, the numbers of a latent state.
int StateSize(const Config& config, const ObservationSpec& spec);
// J, the joint features of state and action.
int JointSize(const Config& config, const ObservationSpec& spec);

}  // namespace shoal::learner
