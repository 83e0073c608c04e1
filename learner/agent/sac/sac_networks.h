// SPDX-License-Identifier: Apache-2.0
// Which networks SAC trains, and what follows them. Names are those of its tensors:
//
//   encoder.*, critic.*    trained by the critic's loss, one optimiser
//   actor.*                trained by the actor's loss on the same features, detached
//   target.*               trunk and Q functions that follow critic.*, on the critic's features
//   average.*              moving average of encoder.* and actor.*
//   temperature.log        one number
//
// network.encoders = separate: encoder.* is the actor's, trained by its loss; the critic has
// critic.encoder.* instead. network.target_encoder: target.encoder.* follows the critic's encoder,
// and the target stands on its features.
//
// sac.critic_blocks: the critic is asymmetric: it sees no pixels, and encoder.* is the actor's,
// trained by its loss.
//
// sac.aux: aux.*, trained together with the encoder, by a loss of its own beside the other.
//
// Dimensions: B batch (of several replicas: the rows of this one), A actions, V vector size, K*C
// channels. A result is valid until the function that returned it is called again.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "common/config/config.h"
#include "common/nn/actor_module.h"
#include "common/nn/adam.h"
#include "common/nn/critic_module.h"
#include "common/nn/encoder_module.h"
#include "common/nn/safetensors.h"
#include "common/spec/observation_spec.h"
#include "learner/agent/agent_state.h"
#include "learner/agent/aux_loss.h"
#include "learner/agent/policy_average.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

// Not movable. One thread; passes over parameters use the current nn::ThreadScope.
class SacNetworks {
 public:
  // Seed, learning rates, clipping and initial temperature of `config`. Borrows the engine.
  SacNetworks(const Config& config, const ObservationSpec& spec, Engine* engine);
  SacNetworks(const SacNetworks&) = delete;
  SacNetworks& operator=(const SacNetworks&) = delete;

  // frames (B, K*C, H, W). The features stay until the next call and are what the heads below see.
  // Without pixels these do nothing.
  //
  // For actor and target, by running statistics.
  void EncodeNext(Frames frames);
  // For critic and, of shared encoders, actor; by the batch's statistics. Nothing of an asymmetric
  // critic.
  void Encode(Frames frames);
  // For the actor's loss, after the critic's step, the frames of the latest Encode. An encoder of
  // the actor's own: by the batch's statistics; then the critic's, if any, anew by running ones. A
  // shared one's features stay those of before the step.
  void EncodeForActor(Frames frames);

  // vector (B, V) of the actor; of critic and target theirs (critic_vectors.h); action (B, A).
  struct Gaussian {
    Array mean, log_std;  // (B, A), before tanh
  };
  Gaussian ForwardActor(Array vector);
  using TwinQ = std::array<Array, 2>;  // (B)
  TwinQ ForwardTarget(Array vector, Array action);
  TwinQ ForwardCritic(Array vector, Array action);

  // True if the head trains the encoder and there are labels (sac.aux): their loss is then added,
  // for the features of the head's latest forward pass and before its backward pass.
  enum class Head { kCritic, kActor };
  bool Aux(Head head) const { return aux_ && (head == Head::kActor) == ActorTrains(); }
  // `drawn` as it was drawn. Returns the mean square error of the labels: AuxLoss::mean_square.
  // CHECK: there is one.
  Number ForwardBackwardAux(const Transitions& drawn);

  // Gradients of critic and its encoder from dL/dq_i (B) of the latest ForwardCritic, which has to
  // be of the latest Encode. They are gathered: `squares` as Engine::Gather's.
  void BackwardCritic(std::span<const Array> q_gradients, Number squares);
  // dL/daction (B, A) of the latest ForwardCritic alone.
  void BackwardAction(std::span<const Array> q_gradients, Array action_gradient);
  // Gradients of the actor, and of an encoder of its own, from dL/dmean, dL/dlog_std (B, A) of the
  // latest ForwardActor; gathered.
  void BackwardActor(Array mean_gradient, Array log_std_gradient, Number squares);

  // On the learning rates of all parts, for the steps from now on.
  void SetRateFactor(Number factor);
  // One optimiser step with the latest gradients, as Engine::Step. Features stay those of before.
  void StepCritic();
  void StepActor();
  // The temperature as it is.
  void ReadTemperature(Number temperature);
  // One step of the temperature: Engine::StepTemperature.
  void StepTemperature(Number loss, double least);
  // target += tau * (critic - target), a target encoder included (Eq. 9).
  void MoveTarget(float tau);
  // average += rate * (policy - average), encoder and actor (Eq. 12).
  void MovePolicyAverage(float rate) { average_.Move(rate); }

  // encoder.* and actor.*, F32: the newest ones, and their moving average (PolicyAverage::Tensors).
  nn::TensorMap PolicyTensors() const;
  nn::TensorMap AveragedPolicyTensors() const { return average_.Tensors(); }
  // Parameters, targets, averages and optimisers; `state` borrows them.
  void AddTo(AgentState* state);

 private:
  // Whether the actor's loss trains the policy's encoder; else the critic's does.
  bool ActorTrains() const { return encoder_ && (asymmetric_ || critic_encoder_); }
  nn::EncoderModule* CriticEncoder();  // null without pixels
  std::vector<nn::ParameterSet*> CriticSets();
  std::vector<nn::ParameterSet*> ActorSets();
  // The modules that the critic's step changes, and those that the actor's does.
  std::vector<nn::Module*> CriticModules();
  std::vector<nn::Module*> ActorModules();

  Engine* const engine_;
  const bool asymmetric_;  // the critic sees no pixels
  // Null without pixels: the policy's, which is the critic's, too, unless that has its own.
  const std::unique_ptr<nn::EncoderModule> encoder_;
  const std::unique_ptr<nn::EncoderModule> critic_encoder_;  // null: encoder_
  const std::unique_ptr<nn::EncoderModule> target_encoder_;  // null: the critic's
  nn::CriticModule critic_, target_;
  nn::ActorModule actor_;
  const std::unique_ptr<AuxLoss> aux_;  // null without sac.aux
  nn::ParameterSet temperature_;
  PolicyAverage average_;
  nn::Adam critic_optimiser_, actor_optimiser_, temperature_optimiser_;
};

}  // namespace shoal::learner
