// SPDX-License-Identifier: Apache-2.0
// Plans of encoder, actor and critic as the configuration asks for them: the one place that knows
// the names of parameters. Checkpoints, weights on the wire and layers use these names.
//
// Dimensions: F trunk outputs, V vector size, A actions, H_i hidden units.
//
//   ENCODER.conv{i}.{weight, bias}                                   only with pixels
//   HEAD.trunk.{weight, bias, norm.weight, norm.bias}                only with pixels
//   MLP.layer{i}.{weight (H_i, H_{i-1}), bias, norm.weight, norm.bias}
//   MLP.output.{weight (outputs, H), bias (outputs)}
//   HEAD.log_std (A)                                                 of an unsquashed actor
//
// HEAD: an actor or a critic, with MLP HEAD.mlp of an actor, HEAD.q1, HEAD.q2, ... of a critic. A
// policy is the encoder "encoder" and the actor "actor". norm of the trunk: where the trunk has a
// LayerNorm; norm of an MLP's layer only with network.layer_norm.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/config/config.h"
#include "common/nn/network_plan.h"
#include "common/spec/observation_spec.h"

namespace shoal::nn {

// From stacks of frames (K*C, H, W) to a feature map. Throws Error (kUsage) where network.encoder
// does not exist or does not fit the images, naming what would fit, and where keys of the compact
// encoder are set beside another. No layers without pixels.
NetworkPlan PlanEncoder(const NetworkConfig& network, const ObservationSpec& spec,
                        const std::string& name = "encoder");

// Plan of the layers above an encoder: a trunk over its features, and MLPs that read
// [trunk | vector (V) | extra columns]. Without pixels the trunk has no layers and no outputs.
struct HeadPlan {
  NetworkPlan trunk = {};
  int vector_columns = 0, extra_columns = 0;
  std::vector<NetworkPlan> mlps = {};

  int trunk_columns() const { return trunk.layers().empty() ? 0 : trunk.output().channels; }
  std::vector<ParameterSpec> Parameters() const;
};

enum class ActorOutput {
  kGaussian,       // 2A: mean, raw log deviation
  kDeterministic,  // A
  kUnsquashed,     // A: mean of a Gaussian that no tanh follows; its log deviation is a parameter
};
// How the raw log deviation is bounded.
enum class LogStd {
  kSmooth,   // by tanh, in [-5, 2]
  kClamped,  // cut off at -20 and 2
};
struct ActorPlan : HeadPlan {
  ActorOutput output = ActorOutput::kGaussian;
  LogStd log_std = LogStd::kSmooth;
  int action_size = 0;
  std::string name = {};  // of the head

  std::vector<ParameterSpec> Parameters() const;
};
ActorPlan PlanActor(const NetworkConfig& network, const ObservationSpec& spec,
                    ActorOutput output = ActorOutput::kGaussian, const std::string& name = "actor");
// `name`: "critic", "target". Q functions `name`.q1 to `name`.q`count` of observation and action.
HeadPlan PlanCritic(const NetworkConfig& network, const ObservationSpec& spec,
                    const std::string& name, int count = 2);

// `outputs` functions of the observation alone, one MLP `name`.mlp of weights with the gains that
// on-policy learning starts from: sqrt(2) in hidden layers, `output_gain` in the last one.
HeadPlan PlanObservationHead(const NetworkConfig& network, const ObservationSpec& spec,
                             const std::string& name, int outputs, double output_gain);

// Tensors (V) that a policy has beside its parameters if its observation is normalised: mean and
// variance of the observations that its network was trained with.
inline constexpr char kObservationMean[] = "observation.mean";
inline constexpr char kObservationVariance[] = "observation.variance";

// Parameters of the encoder and the Gaussian actor.
std::vector<ParameterSpec> PolicyParameters(const NetworkConfig& network,
                                            const ObservationSpec& spec);

}  // namespace shoal::nn
