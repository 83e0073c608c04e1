// SPDX-License-Identifier: Apache-2.0
// policy.json of a checkpoint, schema shoal-policy-1: everything except parameters that acting by
// the policy needs, so that the checkpoint's folder is self-contained.
//
//   version      of the Shoal that wrote it
//   algorithm    learner.algorithm
//   output       gaussian | deterministic | unsquashed: meaning of the actor's last layer
//   network      the configuration keys network.*
//   spec         the observation spec, spec_hash its hash
//   layers       what the network computes, a line per layer (common/nn/plan_text.h)
//
// Parameters and running normalisation are in policy.safetensors. `layers` is derived from the
// members above. If a program derives other layers, it refuses the checkpoint.
#pragma once

#include <string>

#include "common/config/config.h"
#include "common/nn/actor_critic_plan.h"
#include "common/spec/observation_spec.h"

namespace shoal::policy {

struct PolicyDescription {
  std::string version, algorithm;
  nn::ActorOutput output = nn::ActorOutput::kGaussian;
  NetworkConfig network;
  ObservationSpec spec;

  nn::NetworkPlan Encoder() const { return nn::PlanEncoder(network, spec); }
  nn::ActorPlan Actor() const { return nn::PlanActor(network, spec, output); }
};

// The description of a run's policy, by this program's version.
PolicyDescription Describe(const Config& config, const ObservationSpec& spec,
                           nn::ActorOutput output);

// The bytes of policy.json.
std::string WriteDescription(const PolicyDescription& description);

// `source` names the text in errors. Throws Error in one line: another or a newer schema, a missing
// or ill-typed key, a spec that makes no sense, a network that this program does not have or that
// computes something else here.
PolicyDescription ReadDescription(const std::string& text, const std::string& source);

}  // namespace shoal::policy
