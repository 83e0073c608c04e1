// SPDX-License-Identifier: Apache-2.0
// policy.json of a checkpoint, schema shoal-policy-1. The file contains all that a program needs to
// act by the policy, except the parameters, so that the checkpoint's folder is self-contained.
//
//   version      version of Shoal that wrote the file
//   algorithm    learner.algorithm
//   output       gaussian | deterministic | unsquashed: meaning of the actor's last layer
//   network      the configuration keys network.*
//   spec         the observation spec, spec_hash its hash
//   layers       computation of the network, one line for each layer (common/nn/plan_text.h)
//
// Parameters and running normalisation are in policy.safetensors. `layers` is derived from the
// members above. A program that derives other layers from these members refuses the checkpoint.
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

// The description of a run's policy. `version` is the version of this program.
PolicyDescription Describe(const Config& config, const ObservationSpec& spec,
                           nn::ActorOutput output);

// The bytes of policy.json.
std::string WriteDescription(const PolicyDescription& description);

// `source` names the text in errors. Throws Error, in one line, if the schema is unknown, if a key
// is missing or ill-typed, if the spec is invalid, or if this program does not have the network or
// has a network of the same name that computes something else.
PolicyDescription ReadDescription(const std::string& text, const std::string& source);

}  // namespace shoal::policy
