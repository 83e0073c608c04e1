#include "learner/agent/sac_networks.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::learner {
namespace {

using nn::ParameterSet;
using nn::ParameterShape;

constexpr const char* kLogTemperature = "temperature.log";

// The encoder first, so that the heads are one contiguous range.
std::vector<ParameterShape> EncoderAndCritic(const NetworkConfig& network,
                                             const ObservationSpec& spec) {
  std::vector<ParameterShape> shapes = nn::EncoderParameters(network, spec);
  for (ParameterShape& shape : nn::CriticParameters(network, spec, "critic")) {
    shapes.push_back(std::move(shape));
  }
  return shapes;
}

}  // namespace

SacNetworks::SacNetworks(const Config& config, const ObservationSpec& spec, nn::Precision precision)
    : critic_parameters(EncoderAndCritic(config.network, spec), ParameterSet::Use::kTraining),
      actor_parameters(nn::ActorParameters(config.network, spec), ParameterSet::Use::kTraining),
      target_parameters(nn::CriticParameters(config.network, spec, "target"),
                        ParameterSet::Use::kInference),
      temperature_parameters({{kLogTemperature, {1}}}, ParameterSet::Use::kTraining),
      critic_optimiser(&critic_parameters, config.learner.learning_rate),
      actor_optimiser(&actor_parameters, config.learner.learning_rate),
      temperature_optimiser(&temperature_parameters, config.learner.learning_rate),
      critic_heads_offset_(critic_parameters.OffsetOf("critic.")) {
  CHECK(critic_parameters.size() - critic_heads_offset_ == target_parameters.size());
  critic_parameters.Initialise(uint64_t(config.seed));
  actor_parameters.Initialise(uint64_t(config.seed));
  std::copy_n(critic_parameters.values() + critic_heads_offset_, target_parameters.size(),
              target_parameters.values());
  temperature_parameters.values()[0] = float(std::log(config.learner.initial_temperature));

  const auto scratchpad = std::make_shared<nn::Scratchpad>();
  const auto context = [&](const ParameterSet& parameters, bool training) {
    return nn::LayerContext{&parameters, precision, config.learner.batch, training, scratchpad};
  };
  dnnl::memory features, features_gradient;
  if (spec.HasPixels()) {
    encoder.emplace(context(critic_parameters, true), config.network, spec);
    features = encoder->features();
    features_gradient = encoder->features_gradient();
  }
  critic.emplace(context(critic_parameters, true), "critic", config.network, spec, features,
                 features_gradient);
  target.emplace(context(target_parameters, false), "target", config.network, spec, features,
                 dnnl::memory());
  actor.emplace(context(actor_parameters, true), config.network, spec, features);
  RefreshCritic();
  RefreshActor();
  RefreshTarget();
}

float SacNetworks::Temperature() const { return std::exp(temperature_parameters.values()[0]); }

void SacNetworks::StepTemperature(float gradient) {
  *temperature_parameters.Find(kLogTemperature).gradient() = gradient;
  temperature_optimiser.Step();
}

void SacNetworks::RefreshCritic() {
  if (encoder) encoder->Refresh();
  critic->Refresh();
}

void SacNetworks::MoveTarget(float tau) {
  nn::MoveTowards(tau, critic_parameters.values() + critic_heads_offset_, target_parameters.size(),
                  target_parameters.values());
  RefreshTarget();
}

nn::TensorMap SacNetworks::PolicyTensors() const {
  nn::TensorMap all, policy;
  critic_parameters.Export(critic_parameters.values(), "", &all);
  for (auto& [name, tensor] : all) {
    if (name.starts_with("encoder.")) policy[name] = std::move(tensor);
  }
  actor_parameters.Export(actor_parameters.values(), "", &policy);
  return policy;
}

nn::TensorMap SacNetworks::AllTensors() const {
  nn::TensorMap tensors;
  for (const ParameterSet* set :
       {&critic_parameters, &actor_parameters, &target_parameters, &temperature_parameters}) {
    set->Export(set->values(), "", &tensors);
  }
  critic_optimiser.Export("critic", &tensors);
  actor_optimiser.Export("actor", &tensors);
  temperature_optimiser.Export("temperature", &tensors);
  return tensors;
}

void SacNetworks::Restore(const nn::TensorMap& tensors, const std::string& source) {
  const nn::TensorMap former = AllTensors();
  try {
    Import(tensors, source);
  } catch (const Error&) {
    Import(former, "former state");
    throw;
  }
}

void SacNetworks::Import(const nn::TensorMap& tensors, const std::string& source) {
  for (ParameterSet* set :
       {&critic_parameters, &actor_parameters, &target_parameters, &temperature_parameters}) {
    set->Import(tensors, "", source, set->values());
  }
  critic_optimiser.Import(tensors, "critic", source);
  actor_optimiser.Import(tensors, "actor", source);
  temperature_optimiser.Import(tensors, "temperature", source);
  RefreshCritic();
  RefreshActor();
  RefreshTarget();
}

}  // namespace shoal::learner
