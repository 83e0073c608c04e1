// SPDX-License-Identifier: Apache-2.0
// One update, in order (equations of docs/algorithm.md):
//
//   1. targets     next_obs -> encoders -> actor, target heads -> y                (Eq. 5, 15)
//   2. critic      obs -> encoder -> critic heads -> loss -> encoder and critic step   (Eq. 6)
//   3. actor       the features of 2, detached -> actor -> critic heads -> actor step  (Eq. 7)
//   4. temperature from the log-probabilities of 3                                     (Eq. 8)
//   5. target heads follow the critic's                                                (Eq. 9)
//   6. the averaged policy follows encoder and actor                                  (Eq. 12)
//
// 3 and 4 every actor_period updates, 5 every target_period, both from the first update on. An
// encoder keeps one set of activations, so next_obs goes through it first. The temperature in 1 and
// 3 is the one before this update. An encoder with batch normalisation takes running statistics in
// 1, those of the batch in 2 and 3. An actor with an encoder of its own (network.encoders) takes
// that one's features in 3 and trains it, and the critic's heads stand on features of the critic's
// encoder as 2 has left it. An asymmetric critic (learner.critic_blocks) has vectors of its own and
// no encoder; the actor's is trained in 3. Where the encoder is trained, learner.aux joins in (Eq.
// 27).
//
// One of several replicas sees its rows of the batch; 2 and 3 end with gradients and figures of all
// of it.
#include "learner/agent/sac/sac_agent.h"

#include <array>
#include <cmath>
#include <vector>

#include "common/base/check.h"
#include "common/base/random.h"
#include "common/config/privileged_blocks.h"
#include "common/nn/parallel.h"
#include "learner/agent/agent_state.h"
#include "learner/agent/batch_faults.h"
#include "learner/agent/batch_part.h"
#include "learner/agent/critic_figures.h"
#include "learner/agent/critic_vectors.h"
#include "learner/agent/losses.h"
#include "learner/agent/sac/sac_networks.h"
#include "learner/agent/sample_figures.h"
#include "learner/agent/squashed_gaussian.h"
#include "learner/agent/vector_standard.h"

namespace shoal::learner {
namespace {

// H of Eq. 8.
float TargetEntropy(const LearnerConfig& learner, int action_size) {
  return float(learner.target_entropy != 0 ? learner.target_entropy
                                           : learner.target_entropy_per_action * action_size);
}

class SacAgent final : public Agent {
 public:
  SacAgent(const Config& config, const ObservationSpec& spec, nn::Precision precision,
           nn::Replica* replica);

  UpdateOutcome Update(const BatchView& drawn, const OnStageEnd& on_stage_end) override;
  uint64_t updates() const override { return updates_; }
  nn::TensorMap PolicyTensors() const override { return Policy(networks_.PolicyTensors()); }
  nn::TensorMap AveragedPolicyTensors() const override {
    return Policy(networks_.AveragedPolicyTensors());
  }
  nn::TensorMap AllTensors() const override { return state_.Export(); }
  void Restore(const nn::TensorMap& tensors, const std::string& source) override;

 private:
  nn::TensorMap Policy(nn::TensorMap parameters) const {
    standard_.ExportTo(&parameters);
    return parameters;
  }
  // This replica's rows of a batch as they were drawn, and as the networks see them.
  struct Seen {
    BatchView drawn;
    BatchView batch;
    CriticVectors::Vectors of_critic;
  };
  // Actions of the Gaussian with new noise, into gaussian_.
  void Draw(const float* mean, const float* log_std, Random* random);
  void ForwardBackwardAux(const Seen& seen, UpdateFigures* figures);
  void ComputeTargets(const Seen& seen, float temperature, Random* random,
                      const OnStageEnd& on_stage_end);
  bool UpdateCritic(const Seen& seen, const OnStageEnd& on_stage_end, UpdateFigures* figures);
  bool UpdateActor(const Seen& seen, float temperature, Random* random,
                   const OnStageEnd& on_stage_end, UpdateFigures* figures);

  const Config config_;
  nn::Replica* const replica_;
  const int batch_size_, rows_, action_size_;  // B of the batch, b of this replica, A
  const float target_entropy_;
  const ValueBounds bounds_;
  const int threads_;
  SacNetworks networks_;
  VectorStandard standard_;
  CriticVectors critic_vectors_;
  uint64_t updates_ = 0;
  AgentState state_;

  SquashedGaussian gaussian_;
  std::vector<float> targets_;                                             // y (b)
  std::array<std::vector<float>, 2> q_gradients_;                          // (b)
  std::vector<float> action_gradient_, mean_gradient_, log_std_gradient_;  // (b, A)
};

SacAgent::SacAgent(const Config& config, const ObservationSpec& spec, nn::Precision precision,
                   nn::Replica* replica)
    : config_(config),
      replica_(replica),
      batch_size_(config.learner.batch),
      rows_(replica->RowsOf(batch_size_).count),
      action_size_(spec.action_size),
      target_entropy_(TargetEntropy(config.learner, spec.action_size)),
      bounds_(ValueBoundsOf(config.learner)),
      threads_(replica->threads()),
      networks_(config, spec, precision, replica),
      standard_(config.learner, spec.VectorSize(), PrivilegedSize(config.learner, spec)),
      critic_vectors_(config.learner, spec),
      gaussian_(rows_, spec.action_size),
      targets_(size_t(rows_)),
      q_gradients_{targets_, targets_},
      action_gradient_(size_t(rows_) * size_t(spec.action_size)),
      mean_gradient_(action_gradient_),
      log_std_gradient_(action_gradient_) {
  networks_.AddTo(&state_);
  standard_.AddTo(&state_);
  state_.Add(&updates_, "agent.updates");
}

void SacAgent::Draw(const float* mean, const float* log_std, Random* random) {
  const std::vector<double> normals = replica_->Normals(batch_size_, action_size_, random);
  const std::vector<float> noise(normals.begin(), normals.end());
  gaussian_.Transform(mean, log_std, noise.data());
}

void SacAgent::ForwardBackwardAux(const Seen& seen, UpdateFigures* figures) {
  const double square = networks_.ForwardBackwardAux(seen.drawn);
  figures->Set(kAuxError, std::sqrt(replica_->Means({square})[0]));
}

void SacAgent::ComputeTargets(const Seen& seen, float temperature, Random* random,
                              const OnStageEnd& on_stage_end) {
  const BatchView& batch = seen.batch;
  networks_.EncodeNext(batch.next_obs_frames.data());
  const auto [mean, log_std] = networks_.ForwardActor(batch.next_obs_vector.data());
  Draw(mean, log_std, random);
  const auto [q0, q1] = networks_.ForwardTarget(seen.of_critic.next_obs, gaussian_.action());
  const TargetInputs inputs{
      batch.reward.data(), batch.bootstrap.data(), {q0, q1}, gaussian_.log_prob()};
  const TargetRates rates{float(config_.learner.reward_scale), float(config_.learner.discount),
                          temperature, bounds_};
  TdTargets(rows_, inputs, rates, targets_.data());
  AverageCopies(rows_, config_.replay.copies, config_.replay.target_shifts, targets_.data());
  on_stage_end(UpdateStage::kForward);
}

// False where the loss or its gradient is not finite; then no parameter has changed.
bool SacAgent::UpdateCritic(const Seen& seen, const OnStageEnd& on_stage_end,
                            UpdateFigures* figures) {
  const BatchView& batch = seen.batch;
  networks_.Encode(batch.obs_frames.data());
  const auto [q0, q1] = networks_.ForwardCritic(seen.of_critic.obs, batch.action.data());
  on_stage_end(UpdateStage::kForward);
  CriticLossBackward(rows_, q0, targets_.data(), q_gradients_[0].data());
  CriticLossBackward(rows_, q1, targets_.data(), q_gradients_[1].data());
  if (networks_.Aux(SacNetworks::Head::kCritic)) ForwardBackwardAux(seen, figures);
  PostCriticValues(replica_, std::array{q0, q1}, targets_);
  const double squares = networks_.BackwardCritic(q_gradients_);
  const float loss = SetCriticFigures(*replica_, squares, figures);
  on_stage_end(UpdateStage::kBackward);
  if (!Usable(loss, squares)) return false;
  networks_.StepCritic();
  on_stage_end(UpdateStage::kOptimiser);
  return true;
}

// After UpdateCritic. False where the loss or its gradient is not finite; then
// neither actor nor temperature has changed.
bool SacAgent::UpdateActor(const Seen& seen, float temperature, Random* random,
                           const OnStageEnd& on_stage_end, UpdateFigures* figures) {
  networks_.EncodeForActor(seen.batch.obs_frames.data());
  const auto [mean, log_std] = networks_.ForwardActor(seen.batch.obs_vector.data());
  Draw(mean, log_std, random);
  const auto [q0, q1] = networks_.ForwardCritic(seen.of_critic.obs, gaussian_.action());
  const float own_loss = ActorLossForward(rows_, gaussian_.log_prob(), q0, q1, temperature);
  on_stage_end(UpdateStage::kForward);
  ActorLossBackward(rows_, q0, q1, q_gradients_[0].data(), q_gradients_[1].data());
  networks_.BackwardAction(q_gradients_, action_gradient_.data());
  gaussian_.Backward(action_gradient_.data(), temperature / float(rows_), mean_gradient_.data(),
                     log_std_gradient_.data());
  if (networks_.Aux(SacNetworks::Head::kActor)) ForwardBackwardAux(seen, figures);
  replica_->Post({}, {own_loss, gaussian_.Entropy(), gaussian_.Saturation()});
  const double squares = networks_.BackwardActor(mean_gradient_.data(), log_std_gradient_.data());
  const std::vector<double> means = replica_->Posted().means;
  on_stage_end(UpdateStage::kBackward);
  const auto loss = float(means[0]), entropy = float(means[1]);
  const float temperature_loss = TemperatureLoss(temperature, entropy, target_entropy_);
  figures->Set(kActorLoss, loss);
  figures->Set(kTemperatureLoss, temperature_loss);
  figures->Set(kEntropy, entropy);
  figures->Set(kActionSaturation, means[2]);
  figures->Set(kActorGradNorm, std::sqrt(squares));
  if (!Usable(loss, squares) || !std::isfinite(temperature_loss)) return false;
  networks_.StepActor();
  if (config_.learner.temperature == "auto") {
    networks_.StepTemperature(temperature_loss, config_.learner.min_temperature);
  }
  on_stage_end(UpdateStage::kOptimiser);
  return true;
}

UpdateOutcome SacAgent::Update(const BatchView& drawn, const OnStageEnd& on_stage_end) {
  CHECK(int(drawn.reward.size()) == batch_size_) << "batch of " << drawn.reward.size();
  const nn::ThreadScope scope(threads_);
  UpdateOutcome outcome{.figures = {}, .finite = AllFinite(drawn)};
  if (!outcome.finite) return outcome;
  const nn::Replica::Rows rows = replica_->RowsOf(batch_size_);
  const BatchView batch = PartOf(standard_.Seen(drawn), rows);
  const Seen seen{PartOf(drawn, rows), batch, critic_vectors_.Of(batch)};

  Random random(StreamKey(uint64_t(config_.seed), StreamRole::kLearnerUpdate, updates_));
  networks_.SetRateFactor(config_.learner.rate_factor.At(drawn.stored_steps));
  const float temperature = networks_.Temperature();
  ComputeTargets(seen, temperature, &random, on_stage_end);
  outcome.finite = UpdateCritic(seen, on_stage_end, &outcome.figures);
  if (!outcome.finite) return outcome;
  if (updates_ % uint64_t(config_.learner.actor_period) == 0 &&
      !UpdateActor(seen, temperature, &random, on_stage_end, &outcome.figures)) {
    networks_.UndoStepCritic();
    outcome.finite = false;
    return outcome;
  }
  if (updates_ % uint64_t(config_.learner.target_period) == 0) {
    networks_.MoveTarget(float(config_.learner.tau));
  }
  networks_.MovePolicyAverage(float(config_.learner.average_rate));
  standard_.Add(drawn);
  on_stage_end(UpdateStage::kOptimiser);
  ++updates_;
  outcome.figures.Set(kTemperature, networks_.Temperature());
  outcome.figures.Set(kLearningRate, networks_.CriticRate());
  return outcome;
}

void SacAgent::Restore(const nn::TensorMap& tensors, const std::string& source) {
  const nn::ThreadScope scope(threads_);
  state_.Restore(tensors, source);
}

}  // namespace

std::unique_ptr<Agent> MakeSacAgent(const Config& config, const ObservationSpec& spec,
                                    nn::Precision precision, nn::Replica* replica) {
  return std::make_unique<SacAgent>(config, spec, precision, replica);
}

}  // namespace shoal::learner
