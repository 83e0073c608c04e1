// SPDX-License-Identifier: Apache-2.0
// The networks that SAC trains, with their targets and averages. Names of tensors:
//
//   encoder.*, critic.*    trained by the critic's loss, with one optimiser
//   actor.*                trained by the actor's loss; reads the same features, detached
//   target.*               trunk and Q functions that follow critic.*; reads the critic's features
//   average.*              moving average of encoder.* and actor.*
//   temperature.log        logarithm of the temperature
//
// If network.encoders is "separate", the actor's loss trains encoder.*, which only the actor reads,
// and the critic has its own encoder critic.encoder.*. If network.target_encoder is set,
// target.encoder.* follows the critic's encoder, and the target reads the features of
// target.encoder.*.
//
// If sac.critic_blocks is set, the critic is asymmetric: its input has no pixels, and the actor's
// loss trains encoder.*.
//
// If sac.aux is set, an additional loss trains aux.* together with the encoder.
//
// Dimensions: B batch (with several replicas, the rows of this replica), K frames of a stack, (C,
// H, W) of a frame, V vector size, A actions. A result is valid until the next call of the function
// that returned the result.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "common/config/config.h"
#include "common/nn/actor_module.h"
#include "common/nn/adam.h"
#include "common/nn/critic_module.h"
#include "common/nn/encoder_module.h"
#include "common/nn/pending_tensors.h"
#include "common/nn/safetensors.h"
#include "common/spec/observation_spec.h"
#include "learner/agent/agent_state.h"
#include "learner/agent/aux_loss.h"
#include "learner/agent/policy_average.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

// Not movable. Only one thread may use an object; passes over parameters use the current
// nn::ThreadScope.
class SacNetworks {
 public:
  // `config` gives seed, learning rates, clipping and initial temperature. Borrows the engine.
  SacNetworks(const Config& config, const ObservationSpec& spec, Engine* engine);
  SacNetworks(const SacNetworks&) = delete;
  SacNetworks& operator=(const SacNetworks&) = delete;

  // The next three functions encode frames (B, K*C, H, W). The forward functions read the features,
  // which stay valid until the next call. Without pixels, the three functions do nothing.
  //
  // Encodes next observations for actor and target, with running statistics.
  void EncodeNext(Frames frames);
  // Encodes observations for the critic and, if the encoder is shared, for the actor, with the
  // batch's statistics. Does nothing for an asymmetric critic.
  void Encode(Frames frames);
  // Encodes the frames of the latest Encode for the actor's loss, after the critic's step. A
  // separate encoder of the actor uses the batch's statistics; then the critic's encoder, if any,
  // encodes again with running statistics. A shared encoder keeps its features from before the
  // step.
  void EncodeForActor(Frames frames);

  // The vector of ForwardActor is the policy's vector (B, V). The vector of ForwardTarget and
  // ForwardCritic is the critic's vector (critic_vectors.h). Actions are (B, A).
  struct Gaussian {
    Array mean, log_std;  // (B, A), before tanh
  };
  Gaussian ForwardActor(Array vector);
  using Values = std::vector<Array>;  // (B), or quantiles (B, M), of each critic
  Values ForwardTarget(Array vector, Array action);
  Values ForwardCritic(Array vector, Array action);

  // Whether the head trains the encoder and there are labels (sac.aux). If so, ForwardBackwardAux
  // must run between the forward and the backward pass of this head.
  enum class Head { kCritic, kActor };
  bool Aux(Head head) const { return aux_ && (head == Head::kActor) == ActorTrains(); }
  // Adds the auxiliary loss. `drawn`: the batch before normalisation. Returns
  // AuxLoss::mean_square, the mean square error of the labels. CHECKs that sac.aux is set.
  Number ForwardBackwardAux(const Transitions& drawn);

  // Computes the gradients of the critic and its encoder from dL/dq_i, of the shape of the Values
  // of the latest ForwardCritic, which must follow the latest Encode. Also gathers the gradients;
  // `squares`: see Engine::Gather.
  void BackwardCritic(std::span<const Array> q_gradients, Number squares);
  // Computes only dL/daction (B, A) of the latest ForwardCritic.
  void BackwardAction(std::span<const Array> q_gradients, Array action_gradient);
  // Computes and gathers the gradients of the actor, and of the encoder if the actor trains it,
  // from dL/dmean and dL/dlog_std (B, A) of the latest ForwardActor.
  void BackwardActor(Array mean_gradient, Array log_std_gradient, Number squares);

  // Sets a factor on the learning rates of all parts, for the following steps.
  void SetRateFactor(Number factor);
  // One optimiser step with the latest gradients: see Engine::Step. Features do not change.
  void StepCritic();
  void StepActor();
  // Writes the current temperature to the number.
  void ReadTemperature(Number temperature);
  // Makes one step of the temperature: see Engine::StepTemperature.
  void StepTemperature(Number loss, double least);
  // target += tau * (critic - target), including a target encoder (Eq. 9).
  void MoveTarget(float tau);
  // average += rate * (policy - average), for encoder and actor (Eq. 12).
  void MovePolicyAverage(float rate) { average_.Move(rate); }

  // Tensors encoder.* and actor.*, F32. The first function begins a copy of the newest values
  // (Agent::CopyPolicyTensors), the second one returns the moving average (PolicyAverage::Tensors).
  nn::PendingTensors CopyPolicy() const;
  nn::TensorMap AveragedPolicyTensors() const { return average_.Tensors(); }
  // Adds parameters, targets, averages and optimisers. `state` borrows them.
  void AddTo(AgentState* state);

 private:
  // Whether the actor's loss trains the policy's encoder; if not, the critic's loss does.
  bool ActorTrains() const { return encoder_ && (asymmetric_ || critic_encoder_); }
  nn::EncoderModule* CriticEncoder();  // null without pixels
  std::vector<nn::ParameterSet*> CriticSets();
  std::vector<nn::ParameterSet*> ActorSets();
  // The modules that a step of the critic, or of the actor, changes.
  std::vector<nn::Module*> CriticModules();
  std::vector<nn::Module*> ActorModules();

  Engine* const engine_;
  const bool asymmetric_;  // the critic has no pixels as input
  // Encoder of the policy, and of the critic if critic_encoder_ is null. Null without pixels.
  const std::unique_ptr<nn::EncoderModule> encoder_;
  const std::unique_ptr<nn::EncoderModule> critic_encoder_;  // null: the critic uses encoder_
  const std::unique_ptr<nn::EncoderModule> target_encoder_;  // null: uses the critic's encoder
  nn::CriticModule critic_, target_;
  nn::ActorModule actor_;
  const std::unique_ptr<AuxLoss> aux_;  // null without sac.aux
  nn::ParameterSet temperature_;
  PolicyAverage average_;
  nn::Adam critic_optimiser_, actor_optimiser_, temperature_optimiser_;
};

}  // namespace shoal::learner
