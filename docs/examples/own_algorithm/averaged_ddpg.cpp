#include "averaged_ddpg.h"

#include <cmath>
#include <vector>

#include "common/base/check.h"
#include "common/nn/actor_critic_plan.h"
#include "common/nn/actor_module.h"
#include "common/nn/adam.h"
#include "common/nn/critic_module.h"
#include "common/nn/encoder_module.h"
#include "common/nn/parallel.h"
#include "learner/agent/agent_state.h"
#include "learner/agent/batch_faults.h"
#include "learner/agent/encoder_and_head.h"
#include "learner/agent/losses.h"
#include "learner/agent/step_sizes.h"

namespace shoal::learner {
namespace {

constexpr int kCritics = 3;

using Use = nn::Module::Use;

class AveragedDdpgAgent final : public Agent {
 public:
  AveragedDdpgAgent(const Config& config, const ObservationSpec& spec, nn::Precision precision)
      : learner_(config.learner),
        context_(precision, config.learner.batch, nn::Threads()),
        encoder_(MakeEncoder(config.network, spec, Use::kTraining, context_)),
        actor_(PlanOfActor(config, spec, "actor"), Features(), /*trains_encoder=*/false,
               Use::kTraining, context_),
        target_actor_(PlanOfActor(config, spec, "target_actor"), Features(),
                      /*trains_encoder=*/false, Use::kInference, context_),
        critic_(nn::PlanCritic(config.network, spec, "critic", kCritics), Features(),
                /*trains_encoder=*/true, Use::kTraining, context_),
        target_critic_(nn::PlanCritic(config.network, spec, "target", kCritics), Features(),
                       /*trains_encoder=*/false, Use::kInference, context_),
        critic_optimiser_(SetsOf(encoder_.get(), &critic_), CriticStep(learner_)),
        actor_optimiser_({&actor_.parameters()}, ActorStep(learner_)),
        targets_(size_t(learner_.batch)),
        q_gradients_(kCritics, targets_),
        action_gradient_(size_t(learner_.batch) * size_t(spec.action_size)) {
    // Parameters start by their names and the seed: nothing depends on the order here.
    const auto seed = uint64_t(config.seed);
    if (encoder_) encoder_->parameters().Initialise(seed);
    actor_.parameters().Initialise(seed);
    critic_.parameters().Initialise(seed);
    Refresh();
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

  UpdateOutcome Update(const BatchView& batch, const OnStageEnd& on_stage_end) override {
    CHECK(int(batch.reward.size()) == learner_.batch) << "batch of " << batch.reward.size();
    const nn::ThreadScope scope(context_.threads);
    UpdateOutcome outcome{.figures = {}, .finite = AllFinite(batch)};
    if (!outcome.finite) return outcome;
    const double rate_factor = learner_.rate_factor.At(batch.stored_steps);
    critic_optimiser_.set_rate_factor(rate_factor);
    actor_optimiser_.set_rate_factor(rate_factor);
    ComputeTargets(batch);
    on_stage_end(UpdateStage::kForward);
    outcome.finite = UpdateCritic(batch, &outcome.figures);
    if (!outcome.finite) return outcome;
    outcome.finite = UpdateActor(batch, &outcome.figures);
    if (!outcome.finite) {  // an update is whole or not at all
      critic_optimiser_.Undo();
      Refresh();
      return outcome;
    }
    on_stage_end(UpdateStage::kBackward);
    nn::MoveTowards(float(learner_.tau), critic_, &target_critic_);
    nn::MoveTowards(float(learner_.tau), actor_, &target_actor_);
    on_stage_end(UpdateStage::kOptimiser);
    ++updates_;
    return outcome;
  }

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
  void Refresh() {
    if (encoder_) encoder_->Refresh();
    critic_.Refresh();
  }

  void ComputeTargets(const BatchView& batch) {
    if (encoder_) encoder_->Forward(batch.next_obs_frames.data(), nn::Statistics::kRunning);
    const float* vector = batch.next_obs_vector.data();
    target_critic_.ForwardObservation(vector);
    target_critic_.ForwardAction(target_actor_.Forward(vector).action);
    for (size_t b = 0; b < targets_.size(); ++b) {
      float mean = 0;
      for (int k = 0; k < kCritics; ++k) mean += target_critic_.q(k)[b] / kCritics;
      targets_[b] = float(learner_.reward_scale) * batch.reward[b] +
                    batch.bootstrap[b] * float(learner_.discount) * mean;
    }
  }

  bool UpdateCritic(const BatchView& batch, UpdateFigures* figures) {
    if (encoder_) encoder_->Forward(batch.obs_frames.data(), nn::Statistics::kBatch);
    critic_.ForwardObservation(batch.obs_vector.data());
    critic_.ForwardAction(batch.action.data());
    const float* q[kCritics];
    for (int k = 0; k < kCritics; ++k) q[k] = critic_.q(k);
    const CriticLoss loss = CriticLossForward(learner_.batch, q, targets_.data());
    figures->Set(kCriticLoss, loss.loss);
    figures->Set(kQMean, loss.q_mean);
    figures->Set(kTargetMean, loss.target_mean);
    figures->Set(kCriticSpread, Spread(q));
    for (int k = 0; k < kCritics; ++k) {
      CriticLossBackward(learner_.batch, q[k], targets_.data(), q_gradients_[size_t(k)].data());
    }
    critic_.Backward(q_gradients_);
    if (encoder_) encoder_->Backward();
    const double squares = critic_optimiser_.GatherGradients();
    figures->Set(kCriticGradNorm, std::sqrt(squares));
    if (!Usable(loss.loss, squares)) return false;
    critic_optimiser_.Step();
    Refresh();
    return true;
  }

  // The features are still those of obs.
  bool UpdateActor(const BatchView& batch, UpdateFigures* figures) {
    const float* vector = batch.obs_vector.data();
    const auto [mean, log_std, action] = actor_.Forward(vector);
    critic_.ForwardObservation(vector);
    critic_.ForwardAction(action);
    const float loss =
        DeterministicActorLoss({critic_.q(0), size_t(learner_.batch)},
                               {mean, action_gradient_.size()}, learner_.mean_penalty);
    figures->Set(kActorLoss, loss);
    // An empty gradient: no part of the loss.
    std::vector<std::vector<float>> gradients(kCritics);
    gradients[0].assign(size_t(learner_.batch), -1.f / float(learner_.batch));
    critic_.BackwardAction(gradients, action_gradient_.data());
    actor_.BackwardAction(action_gradient_.data(), learner_.mean_penalty);
    if (!Usable(loss, actor_optimiser_.GatherGradients())) return false;
    actor_optimiser_.Step();
    actor_.Refresh();
    return true;
  }

  double Spread(const float* const* q) const {
    double sum = 0;
    for (int b = 0; b < learner_.batch; ++b) {
      double mean = 0, squares = 0;
      for (int k = 0; k < kCritics; ++k) mean += double(q[k][b]) / kCritics;
      for (int k = 0; k < kCritics; ++k) squares += (q[k][b] - mean) * (q[k][b] - mean);
      sum += std::sqrt(squares / kCritics);
    }
    return sum / learner_.batch;
  }

  const LearnerConfig learner_;
  const nn::ModuleContext context_;
  const std::unique_ptr<nn::EncoderModule> encoder_;  // null without pixels
  nn::ActorModule actor_, target_actor_;
  nn::CriticModule critic_, target_critic_;
  nn::Adam critic_optimiser_, actor_optimiser_;
  uint64_t updates_ = 0;
  AgentState state_;

  std::vector<float> targets_;                   // y (B)
  std::vector<std::vector<float>> q_gradients_;  // (B) for each critic
  std::vector<float> action_gradient_;           // (B, A)
};

}  // namespace

std::unique_ptr<Agent> MakeAveragedDdpgAgent(const Config& config, const ObservationSpec& spec,
                                             nn::Precision precision) {
  return std::make_unique<AveragedDdpgAgent>(config, spec, precision);
}

}  // namespace shoal::learner
