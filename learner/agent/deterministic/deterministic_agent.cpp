// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/deterministic/deterministic_agent.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "common/base/check.h"
#include "common/base/random.h"
#include "common/nn/actor_critic_plan.h"
#include "common/nn/actor_module.h"
#include "common/nn/adam.h"
#include "common/nn/critic_module.h"
#include "common/nn/encoder_module.h"
#include "common/nn/parallel.h"
#include "learner/agent/agent_state.h"
#include "learner/agent/batch_faults.h"
#include "learner/agent/batch_part.h"
#include "learner/agent/critic_figures.h"
#include "learner/agent/encoder_and_head.h"
#include "learner/agent/losses.h"
#include "learner/agent/policy_average.h"
#include "learner/agent/sample_figures.h"
#include "learner/agent/step_sizes.h"
#include "learner/agent/vector_standard.h"

namespace shoal::learner {
namespace {

using Use = nn::Module::Use;

nn::ActorPlan PlanActor(const Config& config, const ObservationSpec& spec, const char* name) {
  return nn::PlanActor(config.network, spec, nn::ActorOutput::kDeterministic, name);
}

class DeterministicAgent final : public Agent {
 public:
  DeterministicAgent(const Config& config, const ObservationSpec& spec, nn::Precision precision,
                     const DeterministicOptions& options, nn::Replica* replica);

  UpdateOutcome Update(const BatchView& drawn, const OnStageEnd& on_stage_end) override;
  uint64_t updates() const override { return updates_; }
  nn::TensorMap PolicyTensors() const override;
  nn::TensorMap AveragedPolicyTensors() const override;
  nn::TensorMap AllTensors() const override { return state_.Export(); }
  void Restore(const nn::TensorMap& tensors, const std::string& source) override {
    state_.Restore(tensors, source);
  }

 private:
  void Encode(std::span<const uint8_t> frames, nn::Statistics statistics) {
    if (encoder_) encoder_->Forward(frames.data(), statistics);
  }
  void ComputeTargets(const BatchView& batch, Random* random, const OnStageEnd& on_stage_end);
  bool UpdateCritic(const BatchView& batch, const OnStageEnd& on_stage_end, UpdateFigures* figures);
  void RefreshCritic();  // and the encoder
  bool UpdateActor(const BatchView& batch, const OnStageEnd& on_stage_end, UpdateFigures* figures);
  void MoveTargetsAndAverage();
  // Whether the coming update is one in which something of this period moves.
  bool Due(int period) const { return (updates_ + 1) % uint64_t(period) == 0; }
  std::vector<const float*> Values(const nn::CriticModule& critic) const;

  const Config config_;
  const DeterministicOptions options_;
  nn::Replica* const replica_;
  const int batch_size_, rows_, action_size_;  // B of the batch, b of this replica, A
  const nn::ModuleContext context_;
  const std::unique_ptr<nn::EncoderModule> encoder_;  // null without pixels
  const nn::Features* const features_;
  nn::ActorModule actor_, target_actor_;
  nn::CriticModule critic_, target_critic_;
  PolicyAverage average_;
  nn::Adam critic_optimiser_, actor_optimiser_;
  VectorStandard standard_;
  uint64_t updates_ = 0;
  AgentState state_;

  std::vector<float> target_action_;             // a' (b, A)
  std::vector<float> targets_;                   // y (b)
  std::vector<std::vector<float>> q_gradients_;  // (b) for each critic
  std::vector<float> action_gradient_;           // (b, A)
};

DeterministicAgent::DeterministicAgent(const Config& config, const ObservationSpec& spec,
                                       nn::Precision precision, const DeterministicOptions& options,
                                       nn::Replica* replica)
    : config_(config),
      options_(options),
      replica_(replica),
      batch_size_(config.learner.batch),
      rows_(replica->RowsOf(batch_size_).count),
      action_size_(spec.action_size),
      context_(precision, batch_size_, replica),
      encoder_(MakeEncoder(config.network, spec, Use::kTraining, context_)),
      features_(encoder_ ? &encoder_->features() : nullptr),
      actor_(PlanActor(config, spec, "actor"), features_, /*trains_encoder=*/false, Use::kTraining,
             context_),
      target_actor_(PlanActor(config, spec, "target_actor"), features_, /*trains_encoder=*/false,
                    Use::kInference, context_),
      critic_(nn::PlanCritic(config.network, spec, "critic", options.critics), features_,
              /*trains_encoder=*/true, Use::kTraining, context_),
      target_critic_(nn::PlanCritic(config.network, spec, "target", options.critics), features_,
                     /*trains_encoder=*/false, Use::kInference, context_),
      average_(SetsOf(encoder_.get(), &actor_), replica),
      critic_optimiser_(SetsOf(encoder_.get(), &critic_), CriticStep(config.learner), replica),
      actor_optimiser_({&actor_.parameters()}, ActorStep(config.learner), replica),
      standard_(config.learner, spec.VectorSize()),
      target_action_(size_t(rows_) * size_t(action_size_)),
      targets_(size_t(rows_)),
      q_gradients_(size_t(options.critics), targets_),
      action_gradient_(target_action_) {
  const auto seed = uint64_t(config.seed);
  if (encoder_) {
    encoder_->parameters().Initialise(seed);
    state_.Add(encoder_.get());
  }
  actor_.parameters().Initialise(seed);
  critic_.parameters().Initialise(seed);
  actor_.Refresh();
  RefreshCritic();
  nn::CopyParameters(actor_, &target_actor_);
  nn::CopyParameters(critic_, &target_critic_);
  average_.Copy();
  state_.Add(&actor_);
  state_.Add(&target_actor_);
  state_.Add(&critic_);
  state_.Add(&target_critic_);
  average_.AddTo(&state_);
  state_.Add(&actor_optimiser_, "actor");
  state_.Add(&critic_optimiser_, "critic");
  state_.Add(&updates_, "agent.updates");
  standard_.AddTo(&state_);
}

void DeterministicAgent::RefreshCritic() {
  if (encoder_) encoder_->Refresh();
  critic_.Refresh();
}

std::vector<const float*> DeterministicAgent::Values(const nn::CriticModule& critic) const {
  std::vector<const float*> q;
  q.reserve(size_t(critic.count()));
  for (int i = 0; i < critic.count(); ++i) q.push_back(critic.q(i));
  return q;
}

void DeterministicAgent::ComputeTargets(const BatchView& batch, Random* random,
                                        const OnStageEnd& on_stage_end) {
  const float* vector = batch.next_obs_vector.data();
  Encode(batch.next_obs_frames, nn::Statistics::kRunning);
  std::copy_n(target_actor_.Forward(vector).action, target_action_.size(), target_action_.begin());
  if (options_.target_noise > 0) {
    const std::vector<double> normals = replica_->Normals(batch_size_, action_size_, random);
    for (size_t i = 0; i < normals.size(); ++i) {
      const double noise = std::clamp(options_.target_noise * normals[i],
                                      -options_.target_noise_clip, options_.target_noise_clip);
      target_action_[i] = float(std::clamp(target_action_[i] + noise, -1.0, 1.0));
    }
  }
  target_critic_.ForwardObservation(vector);
  target_critic_.ForwardAction(target_action_.data());
  const TargetRates rates{float(config_.learner.reward_scale), float(config_.learner.discount),
                          /*temperature=*/0, ValueBoundsOf(config_.learner)};
  MinTargets(rows_, batch.reward.data(), batch.bootstrap.data(), Values(target_critic_), rates,
             targets_.data());
  AverageCopies(rows_, config_.replay.copies, config_.replay.target_shifts, targets_.data());
  on_stage_end(UpdateStage::kForward);
}

// False where the loss or its gradient is not finite; then no parameter has changed.
bool DeterministicAgent::UpdateCritic(const BatchView& batch, const OnStageEnd& on_stage_end,
                                      UpdateFigures* figures) {
  Encode(batch.obs_frames, nn::Statistics::kBatch);
  critic_.ForwardObservation(batch.obs_vector.data());
  critic_.ForwardAction(batch.action.data());
  on_stage_end(UpdateStage::kForward);
  for (int i = 0; i < options_.critics; ++i) {
    CriticLossBackward(rows_, critic_.q(i), targets_.data(), q_gradients_[size_t(i)].data());
  }
  critic_.Backward(q_gradients_);
  if (encoder_) encoder_->Backward();
  PostCriticValues(replica_, Values(critic_), targets_);
  const double squares = critic_optimiser_.GatherGradients();
  const float loss = SetCriticFigures(*replica_, squares, figures);
  on_stage_end(UpdateStage::kBackward);
  if (!Usable(loss, squares)) return false;
  critic_optimiser_.Step();
  RefreshCritic();
  replica_->Meet();
  on_stage_end(UpdateStage::kOptimiser);
  return true;
}

// The features are still those of obs. False where the loss or its gradient is not finite; then the
// actor has not changed.
bool DeterministicAgent::UpdateActor(const BatchView& batch, const OnStageEnd& on_stage_end,
                                     UpdateFigures* figures) {
  const float* vector = batch.obs_vector.data();
  const auto [mean, log_std, action] = actor_.Forward(vector);
  critic_.ForwardObservation(vector);
  critic_.ForwardAction(action);
  const float own_loss = DeterministicActorLoss(
      {critic_.q(0), size_t(rows_)}, {mean, action_gradient_.size()}, config_.learner.mean_penalty);
  int64_t saturated = 0;
  for (size_t i = 0; i < action_gradient_.size(); ++i) saturated += std::abs(action[i]) > 0.99f;
  on_stage_end(UpdateStage::kForward);
  // The others are no part of the loss.
  std::vector<std::vector<float>> gradients(size_t(options_.critics));
  gradients[0].assign(size_t(rows_), -1.f / float(rows_));
  critic_.BackwardAction(gradients, action_gradient_.data());
  actor_.BackwardAction(action_gradient_.data(), config_.learner.mean_penalty);
  replica_->Post({}, {own_loss, double(saturated) / double(action_gradient_.size())});
  const double squares = actor_optimiser_.GatherGradients();
  const std::vector<double> means = replica_->Posted().means;
  const auto loss = float(means[0]);
  on_stage_end(UpdateStage::kBackward);
  figures->Set(kActorLoss, loss);
  figures->Set(kActorGradNorm, std::sqrt(squares));
  figures->Set(kActionSaturation, means[1]);
  if (!Usable(loss, squares)) return false;
  actor_optimiser_.Step();
  actor_.Refresh();
  on_stage_end(UpdateStage::kOptimiser);
  return true;
}

void DeterministicAgent::MoveTargetsAndAverage() {
  if (Due(config_.learner.target_period)) {
    const nn::Following targets[] = {{&critic_, &target_critic_}, {&actor_, &target_actor_}};
    nn::MoveTowards(float(config_.learner.tau), targets, replica_);
  }
  average_.Move(float(config_.learner.average_rate));
}

UpdateOutcome DeterministicAgent::Update(const BatchView& drawn, const OnStageEnd& on_stage_end) {
  CHECK(int(drawn.reward.size()) == batch_size_) << "batch of " << drawn.reward.size();
  const nn::ThreadScope scope(context_.threads);
  UpdateOutcome outcome{.figures = {}, .finite = AllFinite(drawn)};
  if (!outcome.finite) return outcome;
  const BatchView batch = PartOf(standard_.Seen(drawn), replica_->RowsOf(batch_size_));
  Random random(StreamKey(uint64_t(config_.seed), StreamRole::kLearnerUpdate, updates_));
  const double rate_factor = config_.learner.rate_factor.At(drawn.stored_steps);
  critic_optimiser_.set_rate_factor(rate_factor);
  actor_optimiser_.set_rate_factor(rate_factor);
  ComputeTargets(batch, &random, on_stage_end);
  outcome.finite = UpdateCritic(batch, on_stage_end, &outcome.figures);
  if (!outcome.finite) return outcome;
  if (Due(config_.learner.actor_period) && !UpdateActor(batch, on_stage_end, &outcome.figures)) {
    critic_optimiser_.Undo();
    RefreshCritic();
    outcome.finite = false;
    return outcome;
  }
  MoveTargetsAndAverage();
  standard_.Add(drawn);
  on_stage_end(UpdateStage::kOptimiser);
  ++updates_;
  outcome.figures.Set(kLearningRate, critic_optimiser_.rate());
  return outcome;
}

nn::TensorMap DeterministicAgent::PolicyTensors() const {
  nn::TensorMap policy;
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
                                              nn::Precision precision,
                                              const DeterministicOptions& options,
                                              nn::Replica* replica) {
  return std::make_unique<DeterministicAgent>(config, spec, precision, options, replica);
}

}  // namespace shoal::learner
