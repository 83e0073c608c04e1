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
#include "learner/agent/critic_vectors.h"
#include "learner/agent/losses.h"
#include "learner/agent/sac/sac_networks.h"
#include "learner/agent/sample_figures.h"
#include "learner/agent/squashed_gaussian.h"
#include "learner/agent/vector_standard.h"

namespace shoal::learner {
namespace {

class SacAgent final : public Agent {
 public:
  SacAgent(const Config& config, const ObservationSpec& spec, nn::Precision precision);

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
  // A batch as it was drawn, and as the networks see it.
  struct Seen {
    const BatchView& drawn;
    BatchView batch;
    CriticVectors::Vectors of_critic;
  };
  void ComputeTargets(const Seen& seen, float temperature, Random* random,
                      const OnStageEnd& on_stage_end);
  bool UpdateCritic(const Seen& seen, const OnStageEnd& on_stage_end, UpdateFigures* figures);
  bool UpdateActor(const Seen& seen, float temperature, Random* random,
                   const OnStageEnd& on_stage_end, UpdateFigures* figures);

  const Config config_;
  const int batch_size_;  // B
  const float target_entropy_;
  const ValueBounds bounds_;
  const int threads_;
  SacNetworks networks_;
  VectorStandard standard_;
  CriticVectors critic_vectors_;
  uint64_t updates_ = 0;
  AgentState state_;

  SquashedGaussian gaussian_;
  std::vector<float> targets_;                                             // y (B)
  std::array<std::vector<float>, 2> q_gradients_;                          // (B)
  std::vector<float> action_gradient_, mean_gradient_, log_std_gradient_;  // (B, A)
};

SacAgent::SacAgent(const Config& config, const ObservationSpec& spec, nn::Precision precision)
    : config_(config),
      batch_size_(config.learner.batch),
      target_entropy_(float(config.learner.target_entropy == 0 ? -spec.action_size
                                                               : config.learner.target_entropy)),
      bounds_(ValueBoundsOf(config.learner)),
      threads_(nn::Threads()),
      networks_(config, spec, precision, threads_),
      standard_(config.learner.normalise_vectors, spec.VectorSize(),
                PrivilegedSize(config.learner, spec)),
      critic_vectors_(config.learner, spec),
      gaussian_(batch_size_, spec.action_size),
      targets_(size_t(batch_size_)),
      q_gradients_{targets_, targets_},
      action_gradient_(size_t(batch_size_) * size_t(spec.action_size)),
      mean_gradient_(action_gradient_),
      log_std_gradient_(action_gradient_) {
  networks_.AddTo(&state_);
  standard_.AddTo(&state_);
  state_.Add(&updates_, "agent.updates");
}

void SacAgent::ComputeTargets(const Seen& seen, float temperature, Random* random,
                              const OnStageEnd& on_stage_end) {
  const BatchView& batch = seen.batch;
  networks_.EncodeNext(batch.next_obs_frames.data());
  const auto [mean, log_std] = networks_.ForwardActor(batch.next_obs_vector.data());
  gaussian_.Sample(mean, log_std, random);
  const auto [q0, q1] = networks_.ForwardTarget(seen.of_critic.next_obs, gaussian_.action());
  const TargetInputs inputs{
      batch.reward.data(), batch.bootstrap.data(), {q0, q1}, gaussian_.log_prob()};
  const TargetRates rates{float(config_.learner.reward_scale), float(config_.learner.discount),
                          temperature, bounds_};
  TdTargets(batch_size_, inputs, rates, targets_.data());
  AverageCopies(batch_size_, config_.replay.copies, targets_.data());
  on_stage_end(UpdateStage::kForward);
}

// False where the loss or its gradient is not finite; then no parameter has changed.
bool SacAgent::UpdateCritic(const Seen& seen, const OnStageEnd& on_stage_end,
                            UpdateFigures* figures) {
  const BatchView& batch = seen.batch;
  networks_.Encode(batch.obs_frames.data());
  const auto [q0, q1] = networks_.ForwardCritic(seen.of_critic.obs, batch.action.data());
  const CriticLoss loss = CriticLossForward(batch_size_, q0, q1, targets_.data());
  on_stage_end(UpdateStage::kForward);
  CriticLossBackward(batch_size_, q0, targets_.data(), q_gradients_[0].data());
  CriticLossBackward(batch_size_, q1, targets_.data(), q_gradients_[1].data());
  if (networks_.Aux(SacNetworks::Head::kCritic)) {
    figures->Set(kAuxError, networks_.ForwardBackwardAux(seen.drawn));
  }
  const double squares = networks_.BackwardCritic(q_gradients_);
  on_stage_end(UpdateStage::kBackward);
  figures->Set(kCriticLoss, loss.loss);
  figures->Set(kQMean, loss.q_mean);
  figures->Set(kTargetMean, loss.target_mean);
  figures->Set(kCriticGradNorm, std::sqrt(squares));
  AddValueFigures(batch_size_, std::array{q0, q1}, figures);
  if (!Usable(loss.loss, squares)) return false;
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
  gaussian_.Sample(mean, log_std, random);
  const auto [q0, q1] = networks_.ForwardCritic(seen.of_critic.obs, gaussian_.action());
  const float loss = ActorLossForward(batch_size_, gaussian_.log_prob(), q0, q1, temperature);
  on_stage_end(UpdateStage::kForward);
  ActorLossBackward(batch_size_, q0, q1, q_gradients_[0].data(), q_gradients_[1].data());
  networks_.BackwardAction(q_gradients_, action_gradient_.data());
  gaussian_.Backward(action_gradient_.data(), temperature / float(batch_size_),
                     mean_gradient_.data(), log_std_gradient_.data());
  if (networks_.Aux(SacNetworks::Head::kActor)) {
    figures->Set(kAuxError, networks_.ForwardBackwardAux(seen.drawn));
  }
  const double squares = networks_.BackwardActor(mean_gradient_.data(), log_std_gradient_.data());
  on_stage_end(UpdateStage::kBackward);
  const float entropy = gaussian_.Entropy();
  const float temperature_loss = TemperatureLoss(temperature, entropy, target_entropy_);
  figures->Set(kActorLoss, loss);
  figures->Set(kTemperatureLoss, temperature_loss);
  figures->Set(kEntropy, entropy);
  figures->Set(kActionSaturation, gaussian_.Saturation());
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
  const BatchView batch = standard_.Seen(drawn);
  const Seen seen{drawn, batch, critic_vectors_.Of(batch)};

  Random random(StreamKey(uint64_t(config_.seed), StreamRole::kLearnerUpdate, updates_));
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
  return outcome;
}

void SacAgent::Restore(const nn::TensorMap& tensors, const std::string& source) {
  const nn::ThreadScope scope(threads_);
  state_.Restore(tensors, source);
}

}  // namespace

std::unique_ptr<Agent> MakeSacAgent(const Config& config, const ObservationSpec& spec,
                                    nn::Precision precision) {
  const nn::ThreadScope scope(nn::Threads());  // layers are built in the size they run in
  return std::make_unique<SacAgent>(config, spec, precision);
}

}  // namespace shoal::learner
