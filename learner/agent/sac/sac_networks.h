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
// learner.critic_blocks: the critic is asymmetric: it sees no pixels, and encoder.* is the actor's,
// trained by its loss.
//
// learner.aux: aux.*, trained together with the encoder, by a loss of its own beside the other.
//
// Dimensions: B batch (of several replicas: the rows of this one), A actions, V vector size, K*C
// channels. Arrays are row-major f32; a result is valid until the function that returned it is
// called again.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/config/config.h"
#include "common/nn/actor_module.h"
#include "common/nn/adam.h"
#include "common/nn/critic_module.h"
#include "common/nn/encoder_module.h"
#include "common/nn/replica.h"
#include "common/nn/safetensors.h"
#include "common/spec/observation_spec.h"
#include "learner/agent/agent_state.h"
#include "learner/agent/aux_loss.h"
#include "learner/agent/policy_average.h"

namespace shoal::learner {

// Not movable. One thread; passes over parameters use the current nn::ThreadScope.
class SacNetworks {
 public:
  // Seed, learning rates, clipping and initial temperature of `config`; the replica's rows of its
  // batch. Borrows the replica, over which gradients are averaged.
  SacNetworks(const Config& config, const ObservationSpec& spec, nn::Precision precision,
              nn::Replica* replica);
  SacNetworks(const SacNetworks&) = delete;
  SacNetworks& operator=(const SacNetworks&) = delete;

  // frames (B, K*C, H, W) u8. The features stay until the next call and are what the heads below
  // see. Without pixels these do nothing.
  //
  // For actor and target, by running statistics.
  void EncodeNext(const uint8_t* frames);
  // For critic and, of shared encoders, actor; by the batch's statistics. Nothing of an asymmetric
  // critic.
  void Encode(const uint8_t* frames);
  // For the actor's loss, after the critic's step, the frames of the latest Encode. An encoder of
  // the actor's own: by the batch's statistics; then the critic's, if any, anew by running ones. A
  // shared one's features stay those of before the step.
  void EncodeForActor(const uint8_t* frames);

  // vector (B, V) of the actor; of critic and target theirs (critic_vectors.h); action (B, A).
  struct Gaussian {
    const float *mean, *log_std;  // (B, A), before tanh
  };
  Gaussian ForwardActor(const float* vector);
  struct TwinQ {
    const float *q0, *q1;  // (B)
  };
  TwinQ ForwardTarget(const float* vector, const float* action);
  TwinQ ForwardCritic(const float* vector, const float* action);

  // True if the head trains the encoder and there are labels (sac.aux): their loss is then added,
  // for the features of the head's latest forward pass and before its backward pass.
  enum class Head { kCritic, kActor };
  bool Aux(Head head) const { return aux_ && (head == Head::kActor) == ActorTrains(); }
  // Mean square error of the labels: AuxLoss::ForwardBackward. CHECK: there is one.
  double ForwardBackwardAux(const BatchView& drawn);

  using QGradients = std::array<std::vector<float>, 2>;  // dL/dq_i (B)
  // Gradients of critic and its encoder from those of the latest ForwardCritic, which has to be of
  // the latest Encode. Returns the sum of their squares.
  double BackwardCritic(const QGradients& q_gradients);
  // dL/daction (B, A) of the latest ForwardCritic alone.
  void BackwardAction(const QGradients& q_gradients, float* action_gradient);
  // Gradients of the actor, and of an encoder of its own, from dL/dmean, dL/dlog_std (B, A) of the
  // latest ForwardActor. Returns the sum of their squares.
  double BackwardActor(const float* mean_gradient, const float* log_std_gradient);

  // On the learning rates of all parts, for the steps from now on.
  void SetRateFactor(double factor);
  double CriticRate() const { return critic_optimiser_.rate(); }
  // One optimiser step with the latest gradients. Features stay those of before. Replicas meet
  // after the critic's, which the actor's loss uses; those that follow are used in the next update.
  void StepCritic();
  // Takes the latest StepCritic back exactly.
  void UndoStepCritic();
  void StepActor();
  float Temperature() const;
  // Gradient of the log temperature, which then is at least log `least`.
  void StepTemperature(float gradient, double least);
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
  void RefreshCritic();

  nn::Replica* const replica_;
  const nn::ModuleContext context_;
  const bool asymmetric_;  // the critic sees no pixels
  // Null without pixels: the policy's, which is the critic's, too, unless that has its own.
  const std::unique_ptr<nn::EncoderModule> encoder_;
  const std::unique_ptr<nn::EncoderModule> critic_encoder_;  // null: encoder_
  const std::unique_ptr<nn::EncoderModule> target_encoder_;  // null: the critic's
  nn::CriticModule critic_, target_;
  nn::ActorModule actor_;
  const std::unique_ptr<AuxLoss> aux_;  // null without learner.aux
  nn::ParameterSet temperature_;
  PolicyAverage average_;
  nn::Adam critic_optimiser_, actor_optimiser_, temperature_optimiser_;
};

}  // namespace shoal::learner
