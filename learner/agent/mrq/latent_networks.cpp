// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/mrq/latent_networks.h"

#include "learner/agent/encoder_and_head.h"

namespace shoal::learner {
namespace {

using Use = nn::Module::Use;

}  // namespace

int StateSize(const Config& config, const ObservationSpec& spec) {
  return nn::PlanState(config.network, spec, "").columns();
}

int JointSize(const Config& config, const ObservationSpec& spec) {
  return nn::PlanLatentModel(config.network, spec, "").joint_columns();
}

// The model of an untrained copy has gradients as well, because the policy's loss passes through
// it.
LatentNetworks::LatentNetworks(const Config& config, const ObservationSpec& spec,
                               const LatentNames& names, int horizon, Engine* engine)
    : encoder_(MakeEncoder(config.network, spec, horizon > 0 ? Use::kTraining : Use::kInference,
                           engine->modules(), names.encoder)),
      state_(nn::PlanState(config.network, spec, names.state),
             encoder_ ? &encoder_->features() : nullptr, /*trains_encoder=*/horizon > 0,
             horizon > 0 ? Use::kTraining : Use::kInference, engine->modules()),
      model_(nn::PlanLatentModel(config.network, spec, names.model), horizon, Use::kTraining,
             engine->modules()) {}

Array LatentNetworks::Encode(Frames frames, Array vector, nn::Statistics statistics) {
  if (encoder_) encoder_->Forward(frames, statistics);
  return state_.Forward(vector);
}

void LatentNetworks::Backward(Array state_gradient) {
  state_.Backward(state_gradient);
  if (encoder_) encoder_->Backward();
}

std::vector<nn::Module*> LatentNetworks::Modules() {
  if (!encoder_) return {&state_, &model_};
  return {encoder_.get(), &state_, &model_};
}

std::vector<nn::ParameterSet*> LatentNetworks::Sets() {
  std::vector<nn::ParameterSet*> sets;
  for (nn::Module* module : Modules()) sets.push_back(&module->parameters());
  return sets;
}

std::vector<const nn::ParameterSet*> LatentNetworks::PolicySets() const {
  if (!encoder_) return {&state_.parameters()};
  return {&encoder_->parameters(), &state_.parameters()};
}

}  // namespace shoal::learner
