// SPDX-License-Identifier: Apache-2.0
// One update, in order (equations of docs/algorithm.md):
//
//   1. targets     next_obs -> encoders -> actor, target heads -> y        (Eq. 5, 15, 30, 35)
//   2. critic      obs -> encoder -> critic heads -> loss -> encoder and critic step   (Eq. 6, 35)
//   3. actor       the features of 2, detached -> actor -> critic heads -> actor step
//                                                                                  (Eq. 7, 30)
//   4. temperature from the log-probabilities of 3                                     (Eq. 8)
//   5. target heads follow the critic's                                                (Eq. 9)
//   6. the averaged policy follows encoder and actor                                  (Eq. 12)
//
// Steps 3 and 4 run every actor_period updates and step 5 every target_period updates, beginning
// with the first update. An encoder holds one set of activations, so next_obs passes through it
// first. Steps 1 and 3 use the temperature from before this update. Batch normalisation uses
// running statistics in 1 and those of the batch in 2 and 3. With separate encoders
// (network.encoders), step 3 computes and trains the actor's own encoder, and the critic's heads
// read features of the critic's encoder as step 2 left it. An asymmetric critic (sac.critic_blocks)
// has its own vectors and no encoder; step 3 trains the actor's. sac.aux (Eq. 27) belongs to the
// step that trains the encoder.
//
// Nothing between Engine::Begin and End depends on a computed number: configuration and counters
// decide which parameters an update changes. Steps 2 and 3 end with gradients and figures of the
// whole batch.
#include "learner/agent/sac/sac_agent.h"

#include <array>
#include <memory>
#include <vector>

#include "common/base/random.h"
#include "common/config/privileged_blocks.h"
#include "common/nn/parallel.h"
#include "learner/agent/agent_state.h"
#include "learner/agent/critic_outputs.h"
#include "learner/agent/critic_vectors.h"
#include "learner/agent/figure_sheet.h"
#include "learner/agent/pending_updates.h"
#include "learner/agent/sac/quantile_values.h"
#include "learner/agent/sac/sac_networks.h"
#include "learner/agent/sample_figures.h"
#include "learner/agent/step_sizes.h"
#include "learner/agent/value_bounds.h"
#include "learner/agent/vector_standard.h"

namespace shoal::learner {
namespace {

// H of Eq. 8.
float TargetEntropy(const SacConfig& sac, int action_size) {
  return float(sac.target_entropy != 0 ? sac.target_entropy
                                       : sac.target_entropy_per_action * action_size);
}

// Number of target critics that are drawn for an update; 0: all of them are used (Eq. 30).
int DrawnCritics(const SacConfig& sac) {
  return sac.target_critics == sac.critics ? 0 : sac.target_critics;
}

ActorValue ActorValueOf(const SacConfig& sac) {
  return sac.actor_value == "mean" ? ActorValue::kMean : ActorValue::kMin;
}

// Arrays of the shape of each critic's values.
std::vector<Array> NewGradients(const Config& config, Engine* engine) {
  std::vector<Array> arrays;
  arrays.reserve(size_t(config.sac.critics));
  for (int i = 0; i < config.sac.critics; ++i) {
    arrays.push_back(engine->NewArray(CriticOutputs(config)));
  }
  return arrays;
}

class SacAgent final : public Agent {
 public:
  SacAgent(const Config& config, const ObservationSpec& spec, Engine* engine);

  std::vector<UpdateOutcome> Submit(const BatchView& drawn,
                                    const OnStageEnd& on_stage_end) override;
  std::vector<UpdateOutcome> Finish() override { return pending_.Finish(); }
  uint64_t updates() const override { return updates_; }
  nn::TensorMap PolicyTensors() const override { return CopyPolicyTensors().Take(); }
  nn::PendingTensors CopyPolicyTensors() const override {
    nn::PendingTensors policy = networks_.CopyPolicy();
    standard_.ExportTo(&policy);
    return policy;
  }
  nn::TensorMap AveragedPolicyTensors() const override {
    nn::TensorMap policy = networks_.AveragedPolicyTensors();
    standard_.ExportTo(&policy);
    return policy;
  }
  nn::TensorMap AllTensors() const override { return state_.Export(); }
  void Restore(const nn::TensorMap& tensors, const std::string& source) override;

 private:
  // A batch as drawn, and as the networks see it.
  struct Seen {
    Transitions drawn;
    Transitions batch;
    CriticVectors::Vectors of_critic;
    CriticRows rows;
  };
  // Whether the coming update is one of every `period` updates.
  bool Due(int period) const { return updates_ % uint64_t(period) == 0; }
  void ForwardBackwardAux(const Seen& seen);
  void ComputeTargets(const Seen& seen, Random* random);
  void UpdateCritic(const Seen& seen, const OnStageEnd& on_stage_end);
  void UpdateActor(const Seen& seen, Random* random, const OnStageEnd& on_stage_end);

  const Config config_;
  Engine* const engine_;
  const float target_entropy_;
  const ValueBounds bounds_;
  SacNetworks networks_;
  VectorStandard standard_;
  CriticVectors critic_vectors_;
  CriticRowsMaker critic_rows_;
  const std::unique_ptr<QuantileValues> quantiles_;  // null: a critic has one value
  uint64_t updates_ = 0;
  AgentState state_;

  // Arrays and numbers of an update. Dimensions: b rows of this replica, A actions.
  const SquashedSample sample_;
  const Array targets_;                                             // y (b)
  const std::vector<Array> q_gradients_;                            // (b), or (b, M), of a critic
  const Array action_gradient_, mean_gradient_, log_std_gradient_;  // (b, A)
  const Number rate_factor_;                                        // of the optimisers
  const Number temperature_, next_temperature_;                     // before and after it
  const CriticNumbers critic_numbers_;
  const Number critic_squares_, actor_squares_;  // of gradients
  const Number actor_loss_, entropy_, saturation_, temperature_loss_;
  FigureSheet figures_;
  PendingUpdates pending_{engine_, &figures_, &updates_};
};

SacAgent::SacAgent(const Config& config, const ObservationSpec& spec, Engine* engine)
    : config_(config),
      engine_(engine),
      target_entropy_(TargetEntropy(config.sac, spec.action_size)),
      bounds_(ValueBoundsOf(config.learner)),
      networks_(config, spec, engine),
      standard_(config.learner, engine, spec.VectorSize(), PrivilegedSize(config, spec)),
      critic_vectors_(config, spec, engine),
      critic_rows_(config.replay, engine),
      quantiles_(QuantileValues::Make(config, engine)),
      sample_{engine->NewArray(spec.action_size), engine->NewArray(spec.action_size),
              engine->NewArray(1)},
      targets_(engine->NewArray(1)),
      q_gradients_(NewGradients(config, engine)),
      action_gradient_(engine->NewArray(spec.action_size)),
      mean_gradient_(engine->NewArray(spec.action_size)),
      log_std_gradient_(engine->NewArray(spec.action_size)),
      rate_factor_(engine->NewNumber()),
      temperature_(engine->NewNumber()),
      next_temperature_(engine->NewNumber()),
      critic_numbers_(NewCriticNumbers(config.sac.critics, engine)),
      critic_squares_(engine->NewNumber()),
      actor_squares_(engine->NewNumber()),
      actor_loss_(engine->NewNumber()),
      entropy_(engine->NewNumber()),
      saturation_(engine->NewNumber()),
      temperature_loss_(engine->NewNumber()) {
  networks_.AddTo(&state_);
  standard_.AddTo(&state_);
  state_.Add(&updates_, "agent.updates");
}

void SacAgent::ForwardBackwardAux(const Seen& seen) {
  figures_.SetRoot(kAuxError, networks_.ForwardBackwardAux(seen.drawn));
}

void SacAgent::ComputeTargets(const Seen& seen, Random* random) {
  const Transitions& batch = seen.batch;
  networks_.EncodeNext(batch.next_obs_frames);
  const auto [mean, log_std] = networks_.ForwardActor(batch.next_obs_vector);
  engine_->SampleSquashedGaussian(mean, log_std, random, sample_);
  const auto next_q = networks_.ForwardTarget(seen.of_critic.next_obs, sample_.action);
  TargetTerms terms{.reward = batch.reward,
                    .bootstrap = batch.bootstrap,
                    .next_q = next_q,
                    .drawn = DrawnCritics(config_.sac),
                    .random = random,
                    .next_log_prob = sample_.log_prob,
                    .temperature = temperature_,
                    .reward_scale = float(config_.learner.reward_scale),
                    .discount = float(config_.learner.discount),
                    .bounds = bounds_};
  if (quantiles_) {
    const std::array no_value{quantiles_->zeros()};  // the quantiles are added to the rest
    terms.next_q = no_value;
    terms.bounds = {};
    engine_->Targets(terms, targets_);
    quantiles_->ComputeTargets(targets_, batch.bootstrap, next_q);
    return;
  }
  engine_->Targets(terms, targets_);
  engine_->AverageCopies(config_.replay.copies, config_.replay.target_shifts, targets_);
}

void SacAgent::UpdateCritic(const Seen& seen, const OnStageEnd& on_stage_end) {
  networks_.Encode(seen.batch.obs_frames);
  const auto q = networks_.ForwardCritic(seen.of_critic.obs, seen.batch.action);
  on_stage_end(UpdateStage::kForward);
  CriticNumbers numbers = critic_numbers_;
  if (quantiles_) {
    quantiles_->CriticLoss(q, q_gradients_, critic_numbers_);
    numbers.loss = quantiles_->loss();
  } else {
    engine_->CriticLoss(q, targets_, seen.rows, q_gradients_, critic_numbers_);
  }
  if (networks_.Aux(SacNetworks::Head::kCritic)) ForwardBackwardAux(seen);
  networks_.BackwardCritic(q_gradients_, critic_squares_);
  engine_->RequireFinite(numbers.loss);
  figures_.SetCritic(numbers, critic_squares_);
  on_stage_end(UpdateStage::kBackward);
  networks_.StepCritic();
  on_stage_end(UpdateStage::kOptimiser);
}

// Runs after UpdateCritic.
void SacAgent::UpdateActor(const Seen& seen, Random* random, const OnStageEnd& on_stage_end) {
  networks_.EncodeForActor(seen.batch.obs_frames);
  const auto [mean, log_std] = networks_.ForwardActor(seen.batch.obs_vector);
  engine_->SampleSquashedGaussian(mean, log_std, random, sample_);
  const auto q = networks_.ForwardCritic(seen.of_critic.obs, sample_.action);
  on_stage_end(UpdateStage::kForward);
  if (quantiles_) {
    engine_->EntropyActorLoss(sample_.log_prob, quantiles_->Means(q), ActorValueOf(config_.sac),
                              temperature_, quantiles_->mean_gradients(), actor_loss_);
    quantiles_->SpreadGradients(q_gradients_);
  } else {
    engine_->EntropyActorLoss(sample_.log_prob, q, ActorValueOf(config_.sac), temperature_,
                              q_gradients_, actor_loss_);
  }
  engine_->SquashedGaussianFigures(sample_, entropy_, saturation_);
  networks_.BackwardAction(q_gradients_, action_gradient_);
  engine_->SquashedGaussianBackward(sample_, action_gradient_, temperature_, mean_gradient_,
                                    log_std_gradient_);
  if (networks_.Aux(SacNetworks::Head::kActor)) ForwardBackwardAux(seen);
  networks_.BackwardActor(mean_gradient_, log_std_gradient_, actor_squares_);
  engine_->TemperatureLoss(temperature_, entropy_, target_entropy_, temperature_loss_);
  engine_->RequireFinite(actor_loss_);
  engine_->RequireFinite(temperature_loss_);
  figures_.Set(kActorLoss, actor_loss_);
  figures_.Set(kTemperatureLoss, temperature_loss_);
  figures_.Set(kEntropy, entropy_);
  figures_.Set(kActionSaturation, saturation_);
  figures_.SetRoot(kActorGradNorm, actor_squares_);
  on_stage_end(UpdateStage::kBackward);
  networks_.StepActor();
  if (config_.sac.temperature == "auto") {
    networks_.StepTemperature(temperature_loss_, config_.sac.min_temperature);
  }
  on_stage_end(UpdateStage::kOptimiser);
}

std::vector<UpdateOutcome> SacAgent::Submit(const BatchView& drawn,
                                            const OnStageEnd& on_stage_end) {
  const nn::ThreadScope scope(engine_->modules().threads);
  const double rate_factor = config_.learner.rate_factor.At(drawn.stored_steps);
  engine_->Set(rate_factor_, rate_factor);
  engine_->Begin(drawn);
  const Transitions as_drawn = engine_->Take(drawn), batch = standard_.Seen(as_drawn);
  const Seen seen{as_drawn, batch, critic_vectors_.Of(batch), critic_rows_.Of(drawn, &figures_)};
  Random random(StreamKey(uint64_t(config_.seed), StreamRole::kLearnerUpdate, updates_));
  networks_.SetRateFactor(rate_factor_);
  networks_.ReadTemperature(temperature_);
  ComputeTargets(seen, &random);
  on_stage_end(UpdateStage::kForward);
  UpdateCritic(seen, on_stage_end);
  if (Due(config_.learner.actor_period)) UpdateActor(seen, &random, on_stage_end);
  if (Due(config_.learner.target_period)) networks_.MoveTarget(float(config_.learner.tau));
  networks_.MovePolicyAverage(float(config_.learner.average_rate));
  networks_.ReadTemperature(next_temperature_);
  figures_.Set(kTemperature, next_temperature_);
  figures_.SetValue(kLearningRate, CriticStep(config_.learner).rate * rate_factor);
  standard_.Add(drawn);
  std::vector<UpdateOutcome> outcomes = pending_.End();
  on_stage_end(UpdateStage::kOptimiser);
  return outcomes;
}

void SacAgent::Restore(const nn::TensorMap& tensors, const std::string& source) {
  const nn::ThreadScope scope(engine_->modules().threads);
  state_.Restore(tensors, source);
}

}  // namespace

std::unique_ptr<Agent> MakeSacAgent(const Config& config, const ObservationSpec& spec,
                                    Engine* engine) {
  return std::make_unique<SacAgent>(config, spec, engine);
}

}  // namespace shoal::learner
