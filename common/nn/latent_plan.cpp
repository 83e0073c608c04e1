// SPDX-License-Identifier: Apache-2.0
#include "common/nn/latent_plan.h"

#include <algorithm>
#include <utility>

#include "common/nn/encoders/encoder_kind.h"
#include "common/nn/mlp_plan.h"

namespace shoal::nn {
namespace {

NetworkPlan::Linear Hidden(const NetworkConfig& network, const std::string& name, int outputs) {
  return {.name = name,
          .key = "network.hidden",
          .outputs = outputs,
          .layer_norm = true,
          .activation = Activation::kElu,
          .initialisation = InitialisationOf(network)};
}

NetworkPlan::Linear Output(const NetworkConfig& network, const std::string& name, int outputs) {
  return {.name = name,
          .key = "network.hidden",
          .outputs = outputs,
          .initialisation = InitialisationOf(network)};
}

}  // namespace

std::vector<ParameterSpec> StatePlan::Parameters() const {
  std::vector<ParameterSpec> parameters = trunk.Parameters();
  Append(layers.Parameters(), &parameters);
  return parameters;
}

StatePlan PlanState(const NetworkConfig& network, const ObservationSpec& spec,
                    const std::string& name) {
  StatePlan plan{.trunk = PlanTrunk(network, spec, name), .vector_columns = spec.VectorSize()};
  const int trunk = plan.trunk.layers().empty() ? 0 : plan.trunk.output().channels;
  plan.layers = NetworkPlan({trunk + plan.vector_columns});
  AddStateLayers(network, name + ".mlp", &plan.layers);
  return plan;
}

std::vector<ParameterSpec> LatentModelPlan::Parameters() const {
  std::vector<ParameterSpec> parameters = action.Parameters();
  Append(joint.Parameters(), &parameters);
  Append(heads.Parameters(), &parameters);
  return parameters;
}

LatentModelPlan PlanLatentModel(const NetworkConfig& network, const ObservationSpec& spec,
                                const std::string& name) {
  const int state = PlanState(network, spec, name).columns();
  const int actions = std::max(1, state / 2), joint = network.hidden.back();
  LatentModelPlan plan{.action = NetworkPlan({spec.action_size}),
                       .joint = NetworkPlan({state + actions}),
                       .heads = NetworkPlan({joint})};
  NetworkPlan::Linear action = Hidden(network, name + ".action", actions);
  action.layer_norm = false;
  plan.action.Add(action);
  for (size_t i = 0; i < network.hidden.size(); ++i) {
    plan.joint.Add(Hidden(network, name + ".joint" + std::to_string(i), network.hidden[i]));
  }
  plan.joint.Add(Output(network, name + ".joint.output", joint));
  plan.heads.Add(Output(network, name + ".heads", 1 + state + kRewardBins));
  return plan;
}

ActorPlan PlanStateActor(const NetworkConfig& network, const ObservationSpec& spec,
                         const std::string& name, int state) {
  ActorPlan plan;
  plan.vector_columns = state;
  plan.output = ActorOutput::kDeterministic;
  plan.action_size = spec.action_size;
  plan.name = name;
  NetworkPlan mlp({state});
  AddMlp(network, {.name = name + ".mlp", .first = int(network.state_hidden.size())},
         spec.action_size, &mlp);
  plan.mlps.push_back(std::move(mlp));
  return plan;
}

HeadPlan PlanJointCritic(const NetworkConfig& network, const std::string& name, int joint) {
  HeadPlan plan{.extra_columns = joint};
  for (const char* q : {".q1", ".q2"}) {
    NetworkPlan mlp({joint});
    for (size_t i = 0; i <= network.hidden.size(); ++i) {
      mlp.Add(Hidden(network, name + q + ".layer" + std::to_string(i),
                     network.hidden[std::min(i, network.hidden.size() - 1)]));
    }
    mlp.Add(Output(network, name + q + ".output", 1));
    plan.mlps.push_back(std::move(mlp));
  }
  return plan;
}

}  // namespace shoal::nn
