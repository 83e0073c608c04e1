// SPDX-License-Identifier: Apache-2.0
// Plans of the networks of a latent model, of the policy and of the critics that read its state
// (Eq. 36 to 38 of docs/algorithm.md).
//
// Dimensions: F trunk outputs, V vector size, Z numbers of the latent state, A actions, J numbers
// of the joint features of state and action, R intervals of the reward.
//
//   state    z = layers([ trunk(features) | vector ])        NAME.trunk.*, NAME.mlp.layer{i}.*
//   joint    j = MLP([ z | ELU(action layer(a)) ])            NAME.action.*, NAME.joint{i}.*
//   heads    [ end | next z | reward logits ] = linear(j)     NAME.heads.*
//   policy   MLP(z), the rest of a policy of PlanActor        NAME.mlp.*
//   critic   q_i = MLP_i(j)                                   NAME.q{i}.*
#pragma once

#include <string>
#include <vector>

#include "common/config/config.h"
#include "common/nn/actor_critic_plan.h"
#include "common/nn/network_plan.h"
#include "common/spec/observation_spec.h"

namespace shoal::nn {

struct StatePlan {
  NetworkPlan trunk = {};
  int vector_columns = 0;   // V
  NetworkPlan layers = {};  // over [trunk | vector]; may have no layers

  int columns() const { return layers.output().channels; }  // Z
  std::vector<ParameterSpec> Parameters() const;
};
// The layers between encoder and latent state, under the names of the actor `name`.
StatePlan PlanState(const NetworkConfig& network, const ObservationSpec& spec,
                    const std::string& name);

// R, as in the paper.
inline constexpr int kRewardBins = 65;

struct LatentModelPlan {
  NetworkPlan action = {};  // (A) -> Z / 2, at least 1
  NetworkPlan joint = {};   // (Z + Z / 2) -> J, of the units of network.hidden, then J again
  NetworkPlan heads = {};   // (J) -> 1 + Z + R

  int state_columns() const { return joint.input().channels - action.output().channels; }  // Z
  int joint_columns() const { return joint.output().channels; }                            // J
  int reward_columns() const { return heads.output().channels - 1 - state_columns(); }     // R
  std::vector<ParameterSpec> Parameters() const;
};
LatentModelPlan PlanLatentModel(const NetworkConfig& network, const ObservationSpec& spec,
                                const std::string& name);

// The rest of the deterministic policy PlanActor(network, spec, kDeterministic, name): the layers
// that read the latent state of `state` numbers, as the vector of a head.
ActorPlan PlanStateActor(const NetworkConfig& network, const ObservationSpec& spec,
                         const std::string& name, int state);

// Two Q functions of the joint features (J). The features are the extra columns of the head, so
// that CriticModule::BackwardAction computes their gradient.
HeadPlan PlanJointCritic(const NetworkConfig& network, const std::string& name, int joint);

}  // namespace shoal::nn
