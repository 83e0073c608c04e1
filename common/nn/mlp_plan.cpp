// SPDX-License-Identifier: Apache-2.0
#include "common/nn/mlp_plan.h"

#include "common/nn/actor_critic_plan.h"
#include "common/nn/encoders/encoder_kind.h"

namespace shoal::nn {
namespace {

// The activation that a key selects; LayerNorm belongs to all trunks except relu.
Activation ActivationOf(const std::string& word) {
  if (word == "tanh") return Activation::kTanh;
  return word == "elu" ? Activation::kElu : Activation::kRelu;
}

}  // namespace

NetworkPlan PlanTrunk(const NetworkConfig& network, const ObservationSpec& spec,
                      const std::string& head) {
  if (!spec.HasPixels()) return {};
  const EncoderKind& kind = FindEncoderKind(network.encoder);
  const std::string own = kind.relu_trunk ? "relu" : "tanh";
  const Activation activation = ActivationOf(network.trunk == "auto" ? own : network.trunk);
  NetworkPlan trunk(PlanEncoder(network, spec).output());
  trunk.Add(NetworkPlan::Linear{.name = head + ".trunk",
                                .key = "network.features",
                                .outputs = network.features == 0 ? kind.features : network.features,
                                .layer_norm = activation != Activation::kRelu,
                                .activation = activation,
                                .initialisation = InitialisationOf(network)});
  return trunk;
}

void AddStateLayers(const NetworkConfig& network, const std::string& name, NetworkPlan* plan) {
  for (size_t i = 0; i < network.state_hidden.size(); ++i) {
    plan->Add(NetworkPlan::Linear{.name = name + ".layer" + std::to_string(i),
                                  .key = "network.state_hidden",
                                  .outputs = network.state_hidden[i],
                                  .layer_norm = true,
                                  .activation = Activation::kElu,
                                  .initialisation = InitialisationOf(network)});
  }
}

void AddMlp(const NetworkConfig& network, const MlpLayers& layers, int outputs, NetworkPlan* plan) {
  for (size_t i = 0; i < network.hidden.size(); ++i) {
    plan->Add(
        NetworkPlan::Linear{.name = layers.name + ".layer" + std::to_string(layers.first + int(i)),
                            .key = "network.hidden",
                            .outputs = network.hidden[i],
                            .layer_norm = network.layer_norm,
                            .activation = ActivationOf(network.activation),
                            .initialisation = InitialisationOf(network),
                            .gain = layers.hidden_gain});
  }
  plan->Add(NetworkPlan::Linear{.name = layers.name + ".output",
                                .key = "network.hidden",
                                .outputs = outputs,
                                .initialisation = InitialisationOf(network),
                                .gain = layers.output_gain});
}

}  // namespace shoal::nn
