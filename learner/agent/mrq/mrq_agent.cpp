// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/mrq/mrq_agent.h"

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "common/base/check.h"
#include "common/base/random.h"
#include "common/nn/actor_module.h"
#include "common/nn/adam.h"
#include "common/nn/critic_module.h"
#include "common/nn/latent_plan.h"
#include "common/nn/parallel.h"
#include "learner/agent/agent_state.h"
#include "learner/agent/figure_sheet.h"
#include "learner/agent/mrq/latent_networks.h"
#include "learner/agent/mrq/model_loss.h"
#include "learner/agent/mrq/reward_scales.h"
#include "learner/agent/pending_updates.h"
#include "learner/agent/step_sizes.h"

namespace shoal::learner {
namespace {

using Use = nn::Module::Use;
using Prediction = nn::LatentModelModule::Prediction;
using Inputs = std::span<const std::span<const float>>;
using Outputs = std::span<const std::span<float>>;

constexpr int kCritics = 2;

nn::ActorPlan ActorPlanOf(const Config& config, const ObservationSpec& spec, const char* name) {
  return nn::PlanStateActor(config.network, spec, name, StateSize(config, spec));
}

nn::HeadPlan CriticPlanOf(const Config& config, const ObservationSpec& spec, const char* name) {
  return nn::PlanJointCritic(config.network, name, JointSize(config, spec));
}

class MrqAgent final : public Agent {
 public:
  MrqAgent(const Config& config, const ObservationSpec& spec, Engine* engine);

  std::vector<UpdateOutcome> Submit(const BatchView& drawn,
                                    const OnStageEnd& on_stage_end) override;
  std::vector<UpdateOutcome> Finish() override { return pending_.Finish(); }
  uint64_t updates() const override { return updates_; }
  nn::TensorMap PolicyTensors() const override { return CopyPolicyTensors().Take(); }
  nn::PendingTensors CopyPolicyTensors() const override;
  nn::TensorMap AveragedPolicyTensors() const override { return PolicyTensors(); }
  nn::TensorMap AllTensors() const override { return state_.Export(); }
  void Restore(const nn::TensorMap& tensors, const std::string& source) override {
    state_.Restore(tensors, source);
  }

 private:
  void UpdateModel(const Transitions& batch, const OnStageEnd& on_stage_end);
  void ComputeModelLoss(const Transitions& batch, std::span<const Prediction> predictions);
  void ComputeTargets(const Transitions& batch, Random* random);
  void UpdateCritic(const Transitions& batch, Array state, const CriticRows& rows,
                    const OnStageEnd& on_stage_end);
  void UpdateActor(Array state, const OnStageEnd& on_stage_end);
  void CopyNetworks();

  const Config config_;
  Engine* const engine_;
  LatentNetworks trained_, held_, target_;
  nn::ActorModule actor_, target_actor_;
  nn::CriticModule critic_, target_critic_;
  nn::Adam model_optimiser_, critic_optimiser_, actor_optimiser_;
  CriticRowsMaker critic_rows_;
  RewardScales scales_;
  uint64_t updates_ = 0;
  AgentState state_;

  // Arrays and numbers of an update. Dimensions: b rows of this replica, A actions, Z numbers of a
  // state, J joint features.
  std::vector<Array> target_states_;                 // (b, Z) for each step
  std::vector<Prediction> gradients_;                // of the model's loss, for each step
  const Array state_loss_, reward_loss_, end_loss_;  // (b)
  const Array state_gradient_;                       // (b, Z)
  const Array scale_rows_;                           // (b, 2): scales of critics and targets
  const Array noisy_action_;                         // (b, A)
  const Array targets_;                              // y (b)
  const std::array<Array, kCritics> q_gradients_;    // (b)
  const Array mean_q_, mean_q_gradient_, q_share_;   // (b)
  const Array joint_gradient_, action_gradient_;     // (b, J), (b, A)
  const Number rate_factor_, noise_;
  const Number state_error_, reward_error_, end_error_;
  const CriticNumbers critic_numbers_;
  const Number model_squares_, critic_squares_, actor_squares_;  // of gradients
  const Number actor_loss_, saturation_, model_loss_;
  const Array model_rows_;  // (b): the loss of each row
  FigureSheet figures_;
  PendingUpdates pending_{engine_, &figures_, &updates_};
};

MrqAgent::MrqAgent(const Config& config, const ObservationSpec& spec, Engine* engine)
    : config_(config),
      engine_(engine),
      trained_(config, spec, {"model.encoder", "model", "model"}, config.mrq.horizon, engine),
      held_(config, spec, {"encoder", "actor", "held"}, 0, engine),
      target_(config, spec, {"target.encoder", "target", "target"}, 0, engine),
      actor_(ActorPlanOf(config, spec, "actor"), nullptr, false, Use::kTraining, engine->modules()),
      target_actor_(ActorPlanOf(config, spec, "target"), nullptr, false, Use::kInference,
                    engine->modules()),
      critic_(CriticPlanOf(config, spec, "critic"), nullptr, false, Use::kTraining,
              engine->modules()),
      target_critic_(CriticPlanOf(config, spec, "target"), nullptr, false, Use::kInference,
                     engine->modules()),
      model_optimiser_(trained_.Sets(), {.rate = config.mrq.encoder_learning_rate},
                       engine->modules()),
      critic_optimiser_({&critic_.parameters()}, CriticStep(config.learner), engine->modules()),
      actor_optimiser_({&actor_.parameters()}, ActorStep(config.learner), engine->modules()),
      critic_rows_(config.replay, engine),
      state_loss_(engine->NewArray(1)),
      reward_loss_(engine->NewArray(1)),
      end_loss_(engine->NewArray(1)),
      state_gradient_(engine->NewArray(StateSize(config, spec))),
      scale_rows_(engine->NewArray(2)),
      noisy_action_(engine->NewArray(spec.action_size)),
      targets_(engine->NewArray(1)),
      q_gradients_{engine->NewArray(1), engine->NewArray(1)},
      mean_q_(engine->NewArray(1)),
      mean_q_gradient_(engine->NewArray(1)),
      q_share_(engine->NewArray(1)),
      joint_gradient_(engine->NewArray(JointSize(config, spec))),
      action_gradient_(engine->NewArray(spec.action_size)),
      rate_factor_(engine->NewNumber()),
      noise_(engine->NewNumber()),
      state_error_(engine->NewNumber()),
      reward_error_(engine->NewNumber()),
      end_error_(engine->NewNumber()),
      critic_numbers_(NewCriticNumbers(kCritics, engine)),
      model_squares_(engine->NewNumber()),
      critic_squares_(engine->NewNumber()),
      actor_squares_(engine->NewNumber()),
      actor_loss_(engine->NewNumber()),
      saturation_(engine->NewNumber()),
      model_loss_(engine->NewNumber()),
      model_rows_(engine->NewArray(1)) {
  const int state = StateSize(config, spec);
  for (int h = 0; h < config.mrq.horizon; ++h) {
    target_states_.push_back(engine->NewArray(state));
    gradients_.push_back(
        {engine->NewArray(1), engine->NewArray(state), engine->NewArray(nn::kRewardBins)});
  }
  const auto seed = uint64_t(config.seed);
  const auto start = [&](nn::Module* module) {
    module->parameters().Initialise(seed);
    module->Refresh();
    state_.Add(module);
  };
  const std::vector<nn::Module*> trained = trained_.Modules();
  for (nn::Module* module : trained) start(module);
  start(&actor_);
  start(&critic_);
  const auto copy = [&](const nn::Module& online, nn::Module* target) {
    nn::CopyParameters(online, target);
    state_.Add(target);
  };
  for (size_t i = 0; i < trained.size(); ++i) {
    copy(*trained[i], held_.Modules()[i]);
    copy(*trained[i], target_.Modules()[i]);
  }
  copy(actor_, &target_actor_);
  copy(critic_, &target_critic_);
  state_.Add(&model_optimiser_, "model");
  state_.Add(&critic_optimiser_, "critic");
  state_.Add(&actor_optimiser_, "actor");
  state_.Add(&updates_, "agent.updates");
  state_.Add([this](nn::TensorMap* tensors) { scales_.Export(tensors); },
             [this](const nn::TensorMap& tensors, const std::string& source) {
               scales_.Import(tensors, source);
             });
}

// All steps are one operation, whose inputs and outputs are the arrays of the steps in order.
void MrqAgent::ComputeModelLoss(const Transitions& batch, std::span<const Prediction> predictions) {
  std::vector<Array> inputs, outputs{state_loss_, reward_loss_, end_loss_, model_rows_};
  for (size_t h = 0; h < predictions.size(); ++h) {
    const Transitions::Step& step = batch.steps[h];
    const Prediction &made = predictions[h], &gradient = gradients_[h];
    const std::array of_step{made.end,    made.state,      made.reward, target_states_[h],
                             step.reward, step.terminated, step.present};
    inputs.insert(inputs.end(), of_step.begin(), of_step.end());
    outputs.insert(outputs.end(), {gradient.end, gradient.state, gradient.reward});
  }
  const ModelLossWeights weights{config_.mrq.reward_weight, config_.mrq.end_weight};
  engine_->OnHost(inputs, outputs, [weights](Inputs in, Outputs out) {
    for (size_t i = 0; i < 3; ++i) std::ranges::fill(out[i], 0.f);
    for (size_t h = 0; 7 * h < in.size(); ++h) {
      const auto from = in.subspan(7 * h, 7);
      const auto to = out.subspan(4 + 3 * h, 3);
      AddModelLoss({from[0], from[1], from[2], from[3], from[4], from[5], from[6]}, weights,
                   {to[0], to[1], to[2]}, {out[0], out[1], out[2]});
    }
    for (size_t b = 0; b < out[3].size(); ++b) {
      out[3][b] = float(out[0][b] + weights.reward * out[1][b] + weights.end * out[2][b]);
    }
  });
  engine_->Mean(model_rows_, model_loss_);
  engine_->Mean(state_loss_, state_error_);
  engine_->Mean(reward_loss_, reward_error_);
  engine_->Mean(end_loss_, end_error_);
}

void MrqAgent::UpdateModel(const Transitions& batch, const OnStageEnd& on_stage_end) {
  std::vector<Array> actions;
  for (size_t h = 0; h < batch.steps.size(); ++h) {
    const Transitions::Step& step = batch.steps[h];
    const Array state = held_.Encode(step.next_frames, step.next_vector, nn::Statistics::kRunning);
    engine_->OnHost(std::array{state}, std::array{target_states_[h]},
                    [](Inputs in, Outputs out) { std::ranges::copy(in[0], out[0].begin()); });
    actions.push_back(step.action);
  }
  const Array state = trained_.Encode(batch.obs_frames, batch.obs_vector, nn::Statistics::kBatch);
  const std::vector<Prediction> predictions = trained_.model().Unroll(state, actions);
  on_stage_end(UpdateStage::kForward);
  ComputeModelLoss(batch, predictions);
  trained_.model().BackwardUnroll(gradients_, state_gradient_);
  trained_.Backward(state_gradient_);
  engine_->Gather(&model_optimiser_, model_squares_);
  engine_->RequireFinite(model_loss_);
  figures_.Set(kModelLoss, model_loss_);
  figures_.Set(kStateError, state_error_);
  figures_.Set(kRewardError, reward_error_);
  figures_.Set(kEndError, end_error_);
  figures_.SetRoot(kModelGradNorm, model_squares_);
  on_stage_end(UpdateStage::kBackward);
  engine_->Step(&model_optimiser_, trained_.Modules(), NextUse::kNextUpdate);
  on_stage_end(UpdateStage::kOptimiser);
}

void MrqAgent::ComputeTargets(const Transitions& batch, Random* random) {
  const Array state =
      target_.Encode(batch.next_obs_frames, batch.next_obs_vector, nn::Statistics::kRunning);
  engine_->AddClippedNoise(target_actor_.Forward(state).action, noise_,
                           config_.mrq.target_noise_clip, random, noisy_action_);
  target_critic_.ForwardObservation({});
  target_critic_.ForwardAction(target_.model().Join(state, noisy_action_));
  const auto discount = float(config_.learner.discount);
  engine_->OnHost(std::array{batch.reward, batch.bootstrap, target_critic_.q(0),
                             target_critic_.q(1), scale_rows_},
                  std::array{targets_}, [discount](Inputs in, Outputs out) {
                    for (size_t b = 0; b < out[0].size(); ++b) {
                      const float next = discount * in[1][b] * std::min(in[2][b], in[3][b]);
                      out[0][b] = (in[0][b] + next * in[4][2 * b + 1]) / in[4][2 * b];
                    }
                  });
}

void MrqAgent::UpdateCritic(const Transitions& batch, Array state, const CriticRows& rows,
                            const OnStageEnd& on_stage_end) {
  critic_.ForwardObservation({});
  critic_.ForwardAction(held_.model().Join(state, batch.action));
  on_stage_end(UpdateStage::kForward);
  engine_->CriticLoss(critic_.values(), targets_, rows, q_gradients_, critic_numbers_);
  critic_.Backward(q_gradients_);
  engine_->Gather(&critic_optimiser_, critic_squares_);
  engine_->RequireFinite(critic_numbers_.loss);
  figures_.SetCritic(critic_numbers_, critic_squares_);
  on_stage_end(UpdateStage::kBackward);
  engine_->Step(&critic_optimiser_, std::array<nn::Module*, 1>{&critic_}, NextUse::kThisUpdate);
  on_stage_end(UpdateStage::kOptimiser);
}

// The policy's loss uses the mean of the two critics, so the gradient of each is half of that of
// the mean.
void MrqAgent::UpdateActor(Array state, const OnStageEnd& on_stage_end) {
  const auto [mean, log_std, action] = actor_.Forward(state);
  critic_.ForwardAction(held_.model().Join(state, action));
  on_stage_end(UpdateStage::kForward);
  engine_->OnHost(std::array{critic_.q(0), critic_.q(1)}, std::array{mean_q_},
                  [](Inputs in, Outputs out) {
                    for (size_t b = 0; b < out[0].size(); ++b) {
                      out[0][b] = (in[0][b] + in[1][b]) / 2;
                    }
                  });
  engine_->DeterministicActorLoss(std::array{mean_q_}, mean, action, config_.learner.mean_penalty,
                                  std::array{mean_q_gradient_}, actor_loss_, saturation_);
  engine_->OnHost(std::array{mean_q_gradient_}, std::array{q_share_}, [](Inputs in, Outputs out) {
    for (size_t b = 0; b < out[0].size(); ++b) out[0][b] = in[0][b] / 2;
  });
  critic_.BackwardAction(std::array{q_share_, q_share_}, joint_gradient_);
  held_.model().BackwardAction(joint_gradient_, action_gradient_);
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

// The targets get the networks that the critics have used until now, and only then do the held
// networks change.
void MrqAgent::CopyNetworks() {
  const std::vector<nn::Module*> trained = trained_.Modules(), held = held_.Modules(),
                                 target = target_.Modules();
  std::vector<nn::Following> to_target{{&actor_, &target_actor_}, {&critic_, &target_critic_}},
      to_held;
  for (size_t i = 0; i < held.size(); ++i) {
    to_target.push_back({held[i], target[i]});
    to_held.push_back({trained[i], held[i]});
  }
  engine_->MoveTowards(1, to_target);
  engine_->MoveTowards(1, to_held);
}

std::vector<UpdateOutcome> MrqAgent::Submit(const BatchView& drawn,
                                            const OnStageEnd& on_stage_end) {
  CHECK(drawn.steps.size() == size_t(config_.mrq.horizon)) << drawn.steps.size() << " steps";
  const nn::ThreadScope scope(engine_->modules().threads);
  const RewardScales scales_before = scales_;
  scales_.Add(drawn);
  if (updates_ % uint64_t(config_.mrq.period) == 0) scales_.Advance();
  std::vector<float> scale_rows(2 * drawn.rows());
  for (size_t b = 0; b < drawn.rows(); ++b) {
    scale_rows[2 * b] = float(scales_.critic());
    scale_rows[2 * b + 1] = float(scales_.target());
  }
  engine_->Put(scale_rows, scale_rows_);
  const double rate_factor = config_.learner.rate_factor.At(drawn.stored_steps);
  engine_->Set(rate_factor_, rate_factor);
  engine_->Set(noise_, config_.mrq.target_noise);

  engine_->Begin(drawn);
  const Transitions batch = engine_->Take(drawn);
  Random random(StreamKey(uint64_t(config_.seed), StreamRole::kLearnerUpdate, updates_));
  for (nn::Adam* optimiser : {&model_optimiser_, &critic_optimiser_, &actor_optimiser_}) {
    engine_->SetRateFactor(rate_factor_, optimiser);
  }
  UpdateModel(batch, on_stage_end);
  ComputeTargets(batch, &random);
  const Array state = held_.Encode(batch.obs_frames, batch.obs_vector, nn::Statistics::kRunning);
  UpdateCritic(batch, state, critic_rows_.Of(drawn, &figures_), on_stage_end);
  UpdateActor(state, on_stage_end);
  figures_.SetValue(kLearningRate, CriticStep(config_.learner).rate * rate_factor);
  figures_.SetValue(kRewardScale, scales_.critic());
  if ((updates_ + 1) % uint64_t(config_.mrq.period) == 0) CopyNetworks();
  on_stage_end(UpdateStage::kOptimiser);

  std::vector<UpdateOutcome> outcomes = pending_.End();
  if (!outcomes.empty() && !outcomes.back().finite) scales_ = scales_before;
  return outcomes;
}

nn::PendingTensors MrqAgent::CopyPolicyTensors() const {
  nn::PendingTensors policy;
  for (const nn::ParameterSet* set : held_.PolicySets()) set->Export(&policy);
  actor_.parameters().Export(&policy);
  return policy;
}

}  // namespace

std::unique_ptr<Agent> MakeMrqAgent(const Config& config, const ObservationSpec& spec,
                                    Engine* engine) {
  return std::make_unique<MrqAgent>(config, spec, engine);
}

}  // namespace shoal::learner
