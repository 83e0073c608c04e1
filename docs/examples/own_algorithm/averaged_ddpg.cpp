#include "averaged_ddpg.h"

#include <array>
#include <cmath>
#include <initializer_list>
#include <vector>

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
#include "learner/agent/step_sizes.h"

namespace shoal::learner {
namespace {

constexpr int kCritics = 3;

using Use = nn::Module::Use;

class AveragedDdpgAgent final : public Agent {
 public:
  AveragedDdpgAgent(const Config& config, const ObservationSpec& spec, Engine* engine)
      : learner_(config.learner),
        engine_(engine),
        encoder_(MakeEncoder(config.network, spec, Use::kTraining, engine->modules())),
        actor_(PlanOfActor(config, spec, "actor"), Features(), /*trains_encoder=*/false,
               Use::kTraining, engine->modules()),
        target_actor_(PlanOfActor(config, spec, "target_actor"), Features(),
                      /*trains_encoder=*/false, Use::kInference, engine->modules()),
        critic_(nn::PlanCritic(config.network, spec, "critic", kCritics), Features(),
                /*trains_encoder=*/true, Use::kTraining, engine->modules()),
        target_critic_(nn::PlanCritic(config.network, spec, "target", kCritics), Features(),
                       /*trains_encoder=*/false, Use::kInference, engine->modules()),
        critic_optimiser_(SetsOf(encoder_.get(), &critic_), CriticStep(learner_),
                          engine->modules()),
        actor_optimiser_({&actor_.parameters()}, ActorStep(learner_), engine->modules()),
        next_q_(engine->NewArray(1)),
        targets_(engine->NewArray(1)),
        spreads_(engine->NewArray(1)),
        actors_q_gradients_(kCritics),
        action_gradient_(engine->NewArray(spec.action_size)),
        critic_numbers_(NewCriticNumbers(kCritics, engine)),
        spread_(engine->NewNumber()),
        critic_squares_(engine->NewNumber()),
        actor_loss_(engine->NewNumber()),
        actor_squares_(engine->NewNumber()),
        saturation_(engine->NewNumber()) {
    for (int k = 0; k < kCritics; ++k) q_gradients_.push_back(engine->NewArray(1));
    actors_q_gradients_[0] = engine->NewArray(1);  // the other critics are no part of its loss
    // Parameters start by their names and the seed: nothing depends on the order here.
    const auto seed = uint64_t(config.seed);
    if (encoder_) encoder_->parameters().Initialise(seed);
    actor_.parameters().Initialise(seed);
    critic_.parameters().Initialise(seed);
    for (nn::Module* module : CriticModules()) module->Refresh();
    actor_.Refresh();
    nn::CopyParameters(actor_, &target_actor_);
    nn::CopyParameters(critic_, &target_critic_);
    // The state in a checkpoint, listed once: export and restore use this list.
    if (encoder_) state_.Add(encoder_.get());
    for (nn::Module* module :
         std::initializer_list<nn::Module*>{&actor_, &target_actor_, &critic_, &target_critic_}) {
      state_.Add(module);
    }
    state_.Add(&critic_optimiser_, "critic");
    state_.Add(&actor_optimiser_, "actor");
    state_.Add(&updates_, "agent.updates");
  }

  std::vector<UpdateOutcome> Submit(const BatchView& drawn,
                                    const OnStageEnd& on_stage_end) override {
    const nn::ThreadScope scope(engine_->modules().threads);
    engine_->Begin(drawn);
    const Transitions batch = engine_->Take(drawn);
    const double rate_factor = learner_.rate_factor.At(drawn.stored_steps);
    critic_optimiser_.set_rate_factor(rate_factor);
    actor_optimiser_.set_rate_factor(rate_factor);
    ComputeTargets(batch);
    on_stage_end(UpdateStage::kForward);
    UpdateCritic(batch);
    UpdateActor(batch);
    on_stage_end(UpdateStage::kBackward);
    engine_->MoveTowards(
        float(learner_.tau),
        std::array<nn::Following, 2>{{{&critic_, &target_critic_}, {&actor_, &target_actor_}}});
    std::vector<UpdateOutcome> outcomes = pending_.End();  // an update is whole or not at all
    on_stage_end(UpdateStage::kOptimiser);
    return outcomes;
  }
  std::vector<UpdateOutcome> Finish() override { return pending_.Finish(); }

  uint64_t updates() const override { return updates_; }
  nn::TensorMap PolicyTensors() const override {
    nn::TensorMap policy;
    if (encoder_) encoder_->parameters().Export(&policy);
    actor_.parameters().Export(&policy);
    return policy;
  }
  // Keeps no average of its own.
  nn::TensorMap AveragedPolicyTensors() const override { return PolicyTensors(); }
  nn::TensorMap AllTensors() const override { return state_.Export(); }
  void Restore(const nn::TensorMap& tensors, const std::string& source) override {
    state_.Restore(tensors, source);
  }

 private:
  static nn::ActorPlan PlanOfActor(const Config& config, const ObservationSpec& spec,
                                   const char* name) {
    return nn::PlanActor(config.network, spec, nn::ActorOutput::kDeterministic, name);
  }
  const nn::Features* Features() const { return encoder_ ? &encoder_->features() : nullptr; }
  // The modules that the critic's step changes.
  std::vector<nn::Module*> CriticModules() {
    if (!encoder_) return {&critic_};
    return {encoder_.get(), &critic_};
  }
  static std::array<Array, kCritics> Values(const nn::CriticModule& critic) {
    return {critic.q(0), critic.q(1), critic.q(2)};
  }

  void ComputeTargets(const Transitions& batch) {
    if (encoder_) encoder_->Forward(batch.next_obs_frames, nn::Statistics::kRunning);
    target_critic_.ForwardObservation(batch.next_obs_vector);
    target_critic_.ForwardAction(target_actor_.Forward(batch.next_obs_vector).action);
    // An operation that no engine has: the mean over critics.
    engine_->OnHost(Values(target_critic_), std::array{next_q_},
                    [](const auto& q, const auto& mean) {
                      for (size_t b = 0; b < mean[0].size(); ++b) {
                        mean[0][b] = 0;
                        for (const auto& one : q) mean[0][b] += one[b] / kCritics;
                      }
                    });
    engine_->Targets({.reward = batch.reward,
                      .bootstrap = batch.bootstrap,
                      .next_q = std::array{next_q_},
                      .next_log_prob = {},
                      .temperature = {},
                      .reward_scale = float(learner_.reward_scale),
                      .discount = float(learner_.discount),
                      .bounds = {}},
                     targets_);
  }

  void UpdateCritic(const Transitions& batch) {
    if (encoder_) encoder_->Forward(batch.obs_frames, nn::Statistics::kBatch);
    critic_.ForwardObservation(batch.obs_vector);
    critic_.ForwardAction(batch.action);
    engine_->CriticLoss(Values(critic_), targets_, /*rows=*/{}, q_gradients_, critic_numbers_);
    engine_->OnHost(Values(critic_), std::array{spreads_}, ComputeSpreads);
    engine_->Mean(spreads_, spread_);
    critic_.Backward(q_gradients_);
    if (encoder_) encoder_->Backward();
    engine_->Gather(&critic_optimiser_, critic_squares_);
    engine_->RequireFinite(critic_numbers_.loss);
    engine_->Step(&critic_optimiser_, CriticModules(), NextUse::kThisUpdate);
    figures_.Set(kCriticLoss, critic_numbers_.loss);
    figures_.Set(kQMean, critic_numbers_.q_mean);
    figures_.Set(kTargetMean, critic_numbers_.target_mean);
    figures_.Set(kCriticSpread, spread_);
    figures_.SetRoot(kCriticGradNorm, critic_squares_);
  }

  // The features are still those of obs.
  void UpdateActor(const Transitions& batch) {
    const auto [mean, log_std, action] = actor_.Forward(batch.obs_vector);
    critic_.ForwardObservation(batch.obs_vector);
    critic_.ForwardAction(action);
    engine_->DeterministicActorLoss(std::array{critic_.q(0)}, mean, action, learner_.mean_penalty,
                                    std::span(actors_q_gradients_).first(1), actor_loss_,
                                    saturation_);
    critic_.BackwardAction(actors_q_gradients_, action_gradient_);
    actor_.BackwardAction(action_gradient_, learner_.mean_penalty);
    engine_->Gather(&actor_optimiser_, actor_squares_);
    engine_->RequireFinite(actor_loss_);
    engine_->Step(&actor_optimiser_, std::array<nn::Module*, 1>{&actor_}, NextUse::kNextUpdate);
    figures_.Set(kActorLoss, actor_loss_);
  }

  // The standard deviation between the critics, of each row.
  static void ComputeSpreads(std::span<const std::span<const float>> q,
                             std::span<const std::span<float>> spreads) {
    for (size_t b = 0; b < spreads[0].size(); ++b) {
      double mean = 0, squares = 0;
      for (const auto& one : q) mean += double(one[b]) / kCritics;
      for (const auto& one : q) squares += (one[b] - mean) * (one[b] - mean);
      spreads[0][b] = float(std::sqrt(squares / kCritics));
    }
  }

  const LearnerConfig learner_;
  Engine* const engine_;
  const std::unique_ptr<nn::EncoderModule> encoder_;  // null without pixels
  nn::ActorModule actor_, target_actor_;
  nn::CriticModule critic_, target_critic_;
  nn::Adam critic_optimiser_, actor_optimiser_;
  uint64_t updates_ = 0;
  AgentState state_;

  const Array next_q_, targets_, spreads_;  // (b): mean_k Q'_k, y, figures of rows
  std::vector<Array> q_gradients_;          // (b) for each critic
  std::vector<Array> actors_q_gradients_;   // the same of the actor's loss
  const Array action_gradient_;             // (b, A)
  const CriticNumbers critic_numbers_;
  const Number spread_, critic_squares_, actor_loss_, actor_squares_, saturation_;
  FigureSheet figures_;
  PendingUpdates pending_{engine_, &figures_, &updates_};
};

}  // namespace

std::unique_ptr<Agent> MakeAveragedDdpgAgent(const Config& config, const ObservationSpec& spec,
                                             Engine* engine) {
  return std::make_unique<AveragedDdpgAgent>(config, spec, engine);
}

}  // namespace shoal::learner
