// SPDX-License-Identifier: Apache-2.0
#include "common/nn/mlp_plan.h"

#include <cmath>
#include <numbers>

#include "common/nn/actor_critic_plan.h"
#include "common/nn/encoders/encoder_kind.h"

namespace shoal::nn {
namespace {

// The activation that a key selects; LayerNorm belongs to all trunks except relu.
Activation ActivationOf(const std::string& word) {
  if (word == "tanh") return Activation::kTanh;
  return word == "elu" ? Activation::kElu : Activation::kRelu;
}

// Number of units inside a block for each of its outputs.
constexpr int kBlockExpansion = 4;

// Appends network.blocks residual blocks over the last layer, and a LayerNorm (Lee et al. 2024,
// arXiv:2410.09754, section 4.2). The gains give orthogonal weights the variance of He et al. 2015
// (arXiv:1502.01852, fan-in), with which the paper's blocks start.
void AddBlocks(const NetworkConfig& network, const std::string& name, NetworkPlan* plan) {
  const int width = plan->output().channels;
  const auto linear = [&](const std::string& layer, int outputs) {
    return NetworkPlan::Linear{.name = layer,
                               .key = "network.blocks",
                               .outputs = outputs,
                               .initialisation = InitialisationOf(network)};
  };
  int stream = int(plan->layers().size()) - 1;
  for (int i = 0; i < network.blocks; ++i) {
    const std::string block = name + ".block" + std::to_string(i);
    plan->Add(NetworkPlan::LayerNorm{.name = block + ".norm", .key = "network.blocks"});
    NetworkPlan::Linear inner = linear(block + ".layer0", kBlockExpansion * width);
    inner.activation = ActivationOf(network.activation);
    inner.gain = std::sqrt(2.0 * kBlockExpansion);
    plan->Add(inner);
    NetworkPlan::Linear outer = linear(block + ".layer1", width);
    outer.gain = std::numbers::sqrt2;
    outer.skip = stream;
    stream = plan->Add(outer);
  }
  plan->Add(NetworkPlan::LayerNorm{.name = name + ".norm", .key = "network.blocks"});
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
  const bool has_blocks = network.blocks > 0;
  for (size_t i = 0; i < network.hidden.size(); ++i) {
    plan->Add(NetworkPlan::Linear{
        .name = layers.name + ".layer" + std::to_string(layers.first + int(i)),
        .key = "network.hidden",
        .outputs = network.hidden[i],
        .layer_norm = network.layer_norm && !has_blocks,
        .activation = has_blocks ? Activation::kNone : ActivationOf(network.activation),
        .initialisation = InitialisationOf(network),
        .gain = layers.hidden_gain});
  }
  if (has_blocks) AddBlocks(network, layers.name, plan);
  plan->Add(NetworkPlan::Linear{.name = layers.name + ".output",
                                .key = "network.hidden",
                                .outputs = outputs,
                                .initialisation = InitialisationOf(network),
                                .gain = layers.output_gain});
}

}  // namespace shoal::nn
