// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/deterministic/deterministic_agent.h"

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "common/base/random.h"
#include "common/nn/actor_critic_plan.h"
#include "common/nn/actor_module.h"
#include "common/nn/adam.h"
#include "common/nn/critic_module.h"
#include "common/nn/encoder_module.h"
#include "common/nn/parallel.h"
#include "learner/agent/agent_state.h"
#include "learner/agent/encoder_and_head.h"
#include "learner/agent/figure_sheet.h"
#include "learner/agent/pending_updates.h"
#include "learner/agent/policy_average.h"
#include "learner/agent/sample_figures.h"
#include "learner/agent/step_sizes.h"
#include "learner/agent/value_bounds.h"
#include "learner/agent/vector_standard.h"

namespace shoal::learner {
namespace {

using Use = nn::Module::Use;

nn::ActorPlan PlanActor(const Config& config, const ObservationSpec& spec, const char* name) {
  return nn::PlanActor(config.network, spec, nn::ActorOutput::kDeterministic, name);
}

class DeterministicAgent final : public Agent {
 public:
  DeterministicAgent(const Config& config, const ObservationSpec& spec,
                     const DeterministicOptions& options, Engine* engine);

  std::vector<UpdateOutcome> Submit(const BatchView& drawn,
                                    const OnStageEnd& on_stage_end) override;
  std::vector<UpdateOutcome> Finish() override { return pending_.Finish(); }
  uint64_t updates() const override { return updates_; }
  nn::TensorMap PolicyTensors() const override { return CopyPolicyTensors().Take(); }
  nn::PendingTensors CopyPolicyTensors() const override;
  nn::TensorMap AveragedPolicyTensors() const override;
  nn::TensorMap AllTensors() const override { return state_.Export(); }
  void Restore(const nn::TensorMap& tensors, const std::string& source) override {
    state_.Restore(tensors, source);
  }

 private:
  void Encode(Frames frames, nn::Statistics statistics) {
    if (encoder_) encoder_->Forward(frames, statistics);
  }
  // Adds noise to an action, if there is noise.
  Array WithNoise(Array action, Random* random);
  void ComputeTargets(const Transitions& batch, Random* random);
  void UpdateCritic(const Transitions& batch, const CriticRows& rows,
                    const OnStageEnd& on_stage_end);
  void UpdateActor(const Transitions& batch, Random* random, const OnStageEnd& on_stage_end);
  void MoveTargetsAndAverage();
  // The modules that the critic's step changes.
  std::vector<nn::Module*> CriticModules();
  // Whether the coming update is one of every `period` updates.
  bool Due(int period) const { return (updates_ + 1) % uint64_t(period) == 0; }

  const Config config_;
  const DeterministicOptions options_;
  Engine* const engine_;
  const std::unique_ptr<nn::EncoderModule> encoder_;  // null without pixels
  const nn::Features* const features_;
  nn::ActorModule actor_;
  const std::unique_ptr<nn::ActorModule> target_actor_;  // null without
  nn::CriticModule critic_, target_critic_;
  PolicyAverage average_;
  nn::Adam critic_optimiser_, actor_optimiser_;
  VectorStandard standard_;
  CriticRowsMaker critic_rows_;
  uint64_t updates_ = 0;
  AgentState state_;

  // Arrays and numbers of an update. Dimensions: b rows of this replica, A actions.
  const Array noisy_action_;               // a' or a~ (b, A)
  const Array targets_;                    // y (b)
  std::vector<Array> q_gradients_;         // (b) for each critic
  std::vector<Array> actors_q_gradients_;  // (b), of the actor's loss: absent for unused critics
  const Array action_gradient_;            // (b, A)
  const Number rate_factor_;               // of the optimisers
  const Number noise_;                     // deviation
  const CriticNumbers critic_numbers_;
  const Number critic_squares_, actor_squares_;  // of gradients
  const Number actor_loss_, saturation_;
  FigureSheet figures_;
  PendingUpdates pending_{engine_, &figures_, &updates_};
};

DeterministicAgent::DeterministicAgent(const Config& config, const ObservationSpec& spec,
                                       const DeterministicOptions& options, Engine* engine)
    : config_(config),
      options_(options),
      engine_(engine),
      encoder_(MakeEncoder(config.network, spec, Use::kTraining, engine->modules())),
      features_(encoder_ ? &encoder_->features() : nullptr),
      actor_(PlanActor(config, spec, "actor"), features_, /*trains_encoder=*/false, Use::kTraining,
             engine->modules()),
      target_actor_(options.target_actor
                        ? std::make_unique<nn::ActorModule>(
                              PlanActor(config, spec, "target_actor"), features_,
                              /*trains_encoder=*/false, Use::kInference, engine->modules())
                        : nullptr),
      critic_(nn::PlanCritic(config.network, spec, "critic", options.critics), features_,
              /*trains_encoder=*/true, Use::kTraining, engine->modules()),
      target_critic_(nn::PlanCritic(config.network, spec, "target", options.critics), features_,
                     /*trains_encoder=*/false, Use::kInference, engine->modules()),
      average_(SetsOf(encoder_.get(), &actor_), engine),
      critic_optimiser_(SetsOf(encoder_.get(), &critic_), CriticStep(config.learner),
                        engine->modules()),
      actor_optimiser_({&actor_.parameters()}, ActorStep(config.learner), engine->modules()),
      standard_(config.learner, engine, spec.VectorSize()),
      critic_rows_(config.replay, engine),
      noisy_action_(engine->NewArray(spec.action_size)),
      targets_(engine->NewArray(1)),
      actors_q_gradients_(size_t(options.critics)),
      action_gradient_(engine->NewArray(spec.action_size)),
      rate_factor_(engine->NewNumber()),
      noise_(engine->NewNumber()),
      critic_numbers_(NewCriticNumbers(options.critics, engine)),
      critic_squares_(engine->NewNumber()),
      actor_squares_(engine->NewNumber()),
      actor_loss_(engine->NewNumber()),
      saturation_(engine->NewNumber()) {
  for (int i = 0; i < options.critics; ++i) q_gradients_.push_back(engine->NewArray(1));
  for (int i = 0; i < options.actor_critics; ++i) {
    actors_q_gradients_[size_t(i)] = engine->NewArray(1);
  }
  const auto seed = uint64_t(config.seed);
  if (encoder_) {
    encoder_->parameters().Initialise(seed);
    state_.Add(encoder_.get());
  }
  actor_.parameters().Initialise(seed);
  critic_.parameters().Initialise(seed);
  actor_.Refresh();
  for (nn::Module* module : CriticModules()) module->Refresh();
  if (target_actor_) nn::CopyParameters(actor_, target_actor_.get());
  nn::CopyParameters(critic_, &target_critic_);
  average_.Copy();
  state_.Add(&actor_);
  if (target_actor_) state_.Add(target_actor_.get());
  state_.Add(&critic_);
  state_.Add(&target_critic_);
  average_.AddTo(&state_);
  state_.Add(&actor_optimiser_, "actor");
  state_.Add(&critic_optimiser_, "critic");
  state_.Add(&updates_, "agent.updates");
  standard_.AddTo(&state_);
}

std::vector<nn::Module*> DeterministicAgent::CriticModules() {
  if (!encoder_) return {&critic_};
  return {encoder_.get(), &critic_};
}

// Whether there is noise depends on the options alone, so that all updates have the same
// operations.
Array DeterministicAgent::WithNoise(Array action, Random* random) {
  if (options_.noise.Most() == 0) return action;
  engine_->AddClippedNoise(action, noise_, options_.noise_clip, random, noisy_action_);
  return noisy_action_;
}

void DeterministicAgent::ComputeTargets(const Transitions& batch, Random* random) {
  Encode(batch.next_obs_frames, nn::Statistics::kRunning);
  nn::ActorModule& actor = target_actor_ ? *target_actor_ : actor_;
  const Array action = WithNoise(actor.Forward(batch.next_obs_vector).action, random);
  target_critic_.ForwardObservation(batch.next_obs_vector);
  target_critic_.ForwardAction(action);
  engine_->Targets({.reward = batch.reward,
                    .bootstrap = batch.bootstrap,
                    .next_q = target_critic_.values(),
                    .next_log_prob = {},
                    .temperature = {},
                    .reward_scale = float(config_.learner.reward_scale),
                    .discount = float(config_.learner.discount),
                    .bounds = ValueBoundsOf(config_.learner)},
                   targets_);
  engine_->AverageCopies(config_.replay.copies, config_.replay.target_shifts, targets_);
}

void DeterministicAgent::UpdateCritic(const Transitions& batch, const CriticRows& rows,
                                      const OnStageEnd& on_stage_end) {
  Encode(batch.obs_frames, nn::Statistics::kBatch);
  critic_.ForwardObservation(batch.obs_vector);
  critic_.ForwardAction(batch.action);
  on_stage_end(UpdateStage::kForward);
  engine_->CriticLoss(critic_.values(), targets_, rows, q_gradients_, critic_numbers_);
  critic_.Backward(q_gradients_);
  if (encoder_) encoder_->Backward();
  engine_->Gather(&critic_optimiser_, critic_squares_);
  engine_->RequireFinite(critic_numbers_.loss);
  figures_.SetCritic(critic_numbers_, critic_squares_);
  on_stage_end(UpdateStage::kBackward);
  engine_->Step(&critic_optimiser_, CriticModules(), NextUse::kThisUpdate);
  on_stage_end(UpdateStage::kOptimiser);
}

// The encoder still holds the features of obs. Neither noise nor clipping of the action changes the
// gradient: da~ / dmu(o) counts as 1.
void DeterministicAgent::UpdateActor(const Transitions& batch, Random* random,
                                     const OnStageEnd& on_stage_end) {
  const auto [mean, log_std, action] = actor_.Forward(batch.obs_vector);
  critic_.ForwardObservation(batch.obs_vector);
  critic_.ForwardAction(options_.noisy_actor_loss ? WithNoise(action, random) : action);
  on_stage_end(UpdateStage::kForward);
  const std::vector<Array> q = critic_.values();
  const auto judges = size_t(options_.actor_critics);
  engine_->DeterministicActorLoss(
      std::span(q).first(judges), mean, action, config_.learner.mean_penalty,
      std::span(actors_q_gradients_).first(judges), actor_loss_, saturation_);
  critic_.BackwardAction(actors_q_gradients_, action_gradient_);
  actor_.BackwardAction(action_gradient_, config_.learner.mean_penalty);
  engine_->Gather(&actor_optimiser_, actor_squares_);
  engine_->RequireFinite(actor_loss_);
  figures_.Set(kActorLoss, actor_loss_);
  figures_.SetRoot(kActorGradNorm, actor_squares_);
  figures_.Set(kActionSaturation, saturation_);
  on_stage_end(UpdateStage::kBackward);
  engine_->Step(&actor_optimiser_, std::array<nn::Module*, 1>{&actor_}, NextUse::kNextUpdate);
  on_stage_end(UpdateStage::kOptimiser);
}

void DeterministicAgent::MoveTargetsAndAverage() {
  if (Due(config_.learner.target_period)) {
    std::vector<nn::Following> targets{{&critic_, &target_critic_}};
    if (target_actor_) targets.push_back({&actor_, target_actor_.get()});
    engine_->MoveTowards(float(config_.learner.tau), targets);
  }
  average_.Move(float(config_.learner.average_rate));
}

std::vector<UpdateOutcome> DeterministicAgent::Submit(const BatchView& drawn,
                                                      const OnStageEnd& on_stage_end) {
  const nn::ThreadScope scope(engine_->modules().threads);
  const double rate_factor = config_.learner.rate_factor.At(drawn.stored_steps);
  engine_->Set(rate_factor_, rate_factor);
  engine_->Set(noise_, options_.noise.At(drawn.stored_steps));
  engine_->Begin(drawn);
  const Transitions batch = standard_.Seen(engine_->Take(drawn));
  Random random(StreamKey(uint64_t(config_.seed), StreamRole::kLearnerUpdate, updates_));
  engine_->SetRateFactor(rate_factor_, &critic_optimiser_);
  engine_->SetRateFactor(rate_factor_, &actor_optimiser_);
  ComputeTargets(batch, &random);
  on_stage_end(UpdateStage::kForward);
  UpdateCritic(batch, critic_rows_.Of(drawn, &figures_), on_stage_end);
  if (Due(config_.learner.actor_period)) UpdateActor(batch, &random, on_stage_end);
  MoveTargetsAndAverage();
  figures_.SetValue(kLearningRate, CriticStep(config_.learner).rate * rate_factor);
  standard_.Add(drawn);
  std::vector<UpdateOutcome> outcomes = pending_.End();
  on_stage_end(UpdateStage::kOptimiser);
  return outcomes;
}

nn::PendingTensors DeterministicAgent::CopyPolicyTensors() const {
  nn::PendingTensors policy;
  if (encoder_) encoder_->parameters().Export(&policy);
  actor_.parameters().Export(&policy);
  standard_.ExportTo(&policy);
  return policy;
}

nn::TensorMap DeterministicAgent::AveragedPolicyTensors() const {
  nn::TensorMap policy = average_.Tensors();
  standard_.ExportTo(&policy);
  return policy;
}

}  // namespace

std::unique_ptr<Agent> MakeDeterministicAgent(const Config& config, const ObservationSpec& spec,
                                              const DeterministicOptions& options, Engine* engine) {
  return std::make_unique<DeterministicAgent>(config, spec, options, engine);
}

}  // namespace shoal::learner
