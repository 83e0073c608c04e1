// SPDX-License-Identifier: Apache-2.0
// Plans of the encoder, actor and critic that a configuration describes. All names of parameters
// are defined here. Checkpoints, weights on the wire and layers use these names.
//
// Dimensions: F trunk outputs, V vector size, A actions, H_i units of hidden layer i (H_{-1}:
// inputs of the MLP), H units of the last hidden layer.
//
//   ENCODER.conv{i}.{weight, bias}                                   only with pixels
//   HEAD.trunk.{weight, bias, norm.weight, norm.bias}                only with pixels
//   MLP.layer{i}.{weight (H_i, H_{i-1}), bias, norm.weight, norm.bias}
//   MLP.block{i}.{norm.{weight, bias}, layer0.{weight (4 H, H), bias}, layer1.{weight (H, 4 H),
//   bias}}, MLP.norm.{weight, bias}                                  only with network.blocks
//   MLP.output.{weight (outputs, H), bias (outputs)}
//   HEAD.log_std (A)                                                 unsquashed actor only
//
// HEAD is an actor or a critic. MLP is HEAD.mlp in an actor and HEAD.q1, HEAD.q2, ... in a critic.
// The layers of network.state_hidden are the first layers of an actor's MLP.
// A policy consists of the encoder "encoder" and the actor "actor". The trunk has norm.* if it has
// a LayerNorm; the layers of an MLP have norm.* if network.layer_norm is set and network.blocks is
// 0.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/config/config.h"
#include "common/nn/network_plan.h"
#include "common/spec/observation_spec.h"

namespace shoal::nn {

// Plan of the encoder, which maps stacks of K frames with C channels, (K*C, height, width), to a
// feature map. The plan has no layers if the observation has no pixels. Throws Error (kUsage)
//   - if network.encoder does not exist,
//   - if the encoder does not fit the images,
//   - if keys of the compact encoder are set, but network.encoder selects another encoder.
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
  kGaussian,       // 2A outputs: mean, and log deviation before it is bounded
  kDeterministic,  // A outputs: action before tanh
  kUnsquashed,     // A outputs: mean of a Gaussian without tanh; the log deviation is a parameter
};
// Method that bounds the log deviation of kGaussian.
enum class LogStd {
  kSmooth,   // by tanh, in [-5, 2]
  kClamped,  // clamped to [-20, 2]
};
struct ActorPlan : HeadPlan {
  ActorOutput output = ActorOutput::kGaussian;
  LogStd log_std = LogStd::kSmooth;
  int action_size = 0;
  std::string name = {};  // name of the head

  std::vector<ParameterSpec> Parameters() const;
};
ActorPlan PlanActor(const NetworkConfig& network, const ObservationSpec& spec,
                    ActorOutput output = ActorOutput::kGaussian, const std::string& name = "actor");
// Plan of `count` Q functions of observation and action, with MLPs `name`.q1, `name`.q2, ...
// `name`: for example "critic" or "target". `outputs`: numbers that each function computes.
HeadPlan PlanCritic(const NetworkConfig& network, const ObservationSpec& spec,
                    const std::string& name, int count = 2, int outputs = 1);

// Plan of one MLP `name`.mlp that computes `outputs` functions of the observation alone. Its
// weights start orthogonal, with gain sqrt(2) in hidden layers and `output_gain` in the last layer,
// as is usual in on-policy learning.
HeadPlan PlanObservationHead(const NetworkConfig& network, const ObservationSpec& spec,
                             const std::string& name, int outputs, double output_gain);

// If the observation of a policy is normalised, the policy has these two tensors (V) in addition to
// its parameters: mean and variance of the observations in training.
inline constexpr char kObservationMean[] = "observation.mean";
inline constexpr char kObservationVariance[] = "observation.variance";

// Parameters of the encoder and the Gaussian actor of a configuration.
std::vector<ParameterSpec> PolicyParameters(const NetworkConfig& network,
                                            const ObservationSpec& spec);

}  // namespace shoal::nn
