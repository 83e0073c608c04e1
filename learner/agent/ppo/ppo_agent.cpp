// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/ppo/ppo_agent.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "common/base/check.h"
#include "common/nn/adam.h"
#include "common/nn/parallel.h"
#include "learner/agent/agent_state.h"
#include "learner/agent/ppo/advantages.h"
#include "learner/agent/ppo/minibatch.h"
#include "learner/agent/ppo/ppo_networks.h"
#include "learner/agent/ppo/reward_scale.h"
#include "learner/agent/vector_standard.h"
#include "learner/engine/batch_faults.h"

namespace shoal::learner {
namespace {

constexpr double kAdamEpsilon = 1e-5;
constexpr double kKlMargin = 1.5;  // an update ends beyond this multiple of target_kl

// Sums over the minibatches of an update.
struct Sums {
  double policy = 0, value = 0, approx_kl = 0, clip_fraction = 0, grad_norm = 0;
  int steps = 0;        // optimiser steps
  int minibatches = 0;  // computed, with or without a step
};

class PpoAgent final : public Agent {
 public:
  PpoAgent(const Config& config, const ObservationSpec& spec, Engine* engine, RowOrder order);

  std::vector<UpdateOutcome> Submit(const BatchView& batch,
                                    const OnStageEnd& on_stage_end) override {
    return {LearnFromRollout(batch, on_stage_end)};
  }
  uint64_t updates() const override { return updates_; }
  nn::TensorMap PolicyTensors() const override;
  nn::TensorMap AveragedPolicyTensors() const override { return PolicyTensors(); }
  nn::TensorMap AllTensors() const override { return state_.Export(); }
  void Restore(const nn::TensorMap& tensors, const std::string& source) override {
    state_.Restore(tensors, source);
  }

 private:
  // A rollout, with the values computed before the first minibatch.
  struct Prepared {
    int rows = 0;                  // N
    std::vector<float> reward;     // (N)
    std::vector<float> value;      // (N)
    std::vector<float> advantage;  // (N)
    std::vector<float> target;     // (N)
  };

  Prepared Prepare(const BatchView& batch);
  // V of the observations in `rows`. The other elements of the result are 0.
  std::vector<float> Values(std::span<const uint8_t> frames, std::span<const float> vectors,
                            const std::vector<int>& rows, int count);
  // Begins an engine update with these rows, in the form that the networks take.
  Transitions TakeRows(const BatchView& batch, const Prepared& prepared, std::span<const int> rows);
  // Runs the operations of that update, then ends the update.
  Engine::Outcome LearnFrom(const Transitions& rows, const OnStageEnd& on_stage_end);
  void AddTo(Sums* sums, const Engine::Outcome& outcome) const;
  UpdateOutcome LearnFromRollout(const BatchView& batch, const OnStageEnd& on_stage_end);
  // Returns false if a number is not finite.
  bool Epochs(const BatchView& batch, const Prepared& prepared, const OnStageEnd& on_stage_end,
              Sums* sums);
  void SetFigures(const BatchView& batch, const Prepared& prepared, const Sums& sums,
                  UpdateFigures* figures) const;
  uint64_t StepsWith(int rows) const { return env_steps_ + uint64_t(rows); }

  const Config config_;
  const int batch_size_;  // B
  const RowOrder order_;
  Engine* const engine_;
  PpoNetworks networks_;
  nn::Adam optimiser_;
  VectorStandard standard_;
  RewardScale rewards_;
  Minibatch minibatch_;
  uint64_t updates_ = 0;
  uint64_t env_steps_ = 0;  // steps learned from; schedules depend on them
  AgentState state_;

  // Arrays and numbers of a minibatch. Dimensions: b rows of this replica, A actions.
  const Array old_value_, advantage_, target_;  // (b)
  const Array mean_gradient_, value_gradient_;  // (b, A), (b)
  const Number rate_factor_, clip_, gradient_squares_, deviation_, entropy_;
  const ClippedPolicyNumbers numbers_;
};

PpoAgent::PpoAgent(const Config& config, const ObservationSpec& spec, Engine* engine,
                   RowOrder order)
    : config_(config),
      batch_size_(config.learner.batch),
      order_(std::move(order)),
      engine_(engine),
      networks_(config, spec, engine),
      optimiser_(networks_.Sets(),
                 {.rate = config.learner.learning_rate,
                  .epsilon = kAdamEpsilon,
                  .max_norm = config.learner.max_grad_norm},
                 engine->modules()),
      standard_(config.learner, engine, spec.VectorSize()),
      rewards_(config.learner.discount),
      minibatch_(spec, config.learner.batch),
      old_value_(engine->NewArray(1)),
      advantage_(engine->NewArray(1)),
      target_(engine->NewArray(1)),
      mean_gradient_(engine->NewArray(spec.action_size)),
      value_gradient_(engine->NewArray(1)),
      rate_factor_(engine->NewNumber()),
      clip_(engine->NewNumber()),
      gradient_squares_(engine->NewNumber()),
      deviation_(engine->NewNumber()),
      entropy_(engine->NewNumber()),
      numbers_{engine->NewNumber(), engine->NewNumber(), engine->NewNumber(),
               engine->NewNumber(), engine->NewNumber(), engine->NewNumber()} {
  networks_.AddTo(&state_);
  state_.Add(&optimiser_, "ppo");
  state_.Add(&updates_, "agent.updates");
  state_.Add(&env_steps_, "agent.env_steps");
  standard_.AddTo(&state_);
  state_.Add([this](nn::TensorMap* tensors) { rewards_.Export(tensors); },
             [this](const nn::TensorMap& tensors, const std::string& source) {
               rewards_.Import(tensors, source);
             });
}

nn::TensorMap PpoAgent::PolicyTensors() const {
  nn::TensorMap policy = networks_.PolicyTensors();
  standard_.ExportTo(&policy);
  return policy;
}

std::vector<float> PpoAgent::Values(std::span<const uint8_t> frames, std::span<const float> vectors,
                                    const std::vector<int>& rows, int count) {
  auto values = std::vector<float>(size_t(count));
  for (size_t at = 0; at < rows.size(); at += size_t(batch_size_)) {
    const auto some = std::span(rows).subspan(at, std::min(rows.size() - at, size_t(batch_size_)));
    minibatch_.TakeObservations(frames, vectors, some);
    // An update of the engine without a step. Its outcome has no meaning: no loss is computed, and
    // the rollout is known to be finite.
    engine_->Begin(minibatch_.View());
    const Transitions batch = standard_.Seen(engine_->Take(minibatch_.View()));
    networks_.ForwardValue(batch.obs_frames, batch.obs_vector);
    engine_->EndAndWait();
    const std::vector<float> read = engine_->ReadRows(networks_.value());
    for (size_t b = 0; b < some.size(); ++b) values[size_t(some[b])] = read[b];
  }
  return values;
}

PpoAgent::Prepared PpoAgent::Prepare(const BatchView& batch) {
  Prepared prepared;
  prepared.rows = int(batch.reward.size());
  const auto rows = size_t(prepared.rows);
  prepared.reward.assign(batch.reward.begin(), batch.reward.end());
  if (config_.ppo.normalise_rewards) {
    prepared.reward = rewards_.Scale(batch.reward, batch.ends, batch.id);
  }
  std::vector<int> all(rows);
  std::iota(all.begin(), all.end(), 0);
  prepared.value = Values(batch.obs_frames, batch.obs_vector, all, prepared.rows);

  std::vector<int> ends;  // steps whose next observation is not the next row
  for (int t = 0; t < prepared.rows; ++t) {
    if (batch.continues[size_t(t)] == 0 && batch.bootstrap[size_t(t)] != 0) ends.push_back(t);
  }
  std::vector<float> next_value =
      Values(batch.next_obs_frames, batch.next_obs_vector, ends, prepared.rows);
  for (size_t t = 0; t + 1 < rows; ++t) {
    if (batch.continues[t] != 0) next_value[t] = prepared.value[t + 1];
  }
  prepared.advantage.resize(rows);
  prepared.target.resize(rows);
  Advantages({.reward = prepared.reward,
              .bootstrap = batch.bootstrap,
              .continues = batch.continues,
              .value = prepared.value,
              .next_value = next_value,
              .discount = config_.learner.discount,
              .lambda = config_.ppo.gae_lambda},
             prepared.advantage, prepared.target);
  return prepared;
}

Transitions PpoAgent::TakeRows(const BatchView& batch, const Prepared& prepared,
                               std::span<const int> rows) {
  minibatch_.Take(batch, rows);
  const auto put = [&](const std::vector<float>& values, Array array) {
    std::vector<float> gathered;
    gathered.reserve(rows.size());
    for (const int row : rows) gathered.push_back(values[size_t(row)]);
    engine_->Put(gathered, array);
  };
  put(prepared.value, old_value_);
  put(prepared.advantage, advantage_);
  put(prepared.target, target_);
  engine_->Begin(minibatch_.View());
  return standard_.Seen(engine_->Take(minibatch_.View()));
}

Engine::Outcome PpoAgent::LearnFrom(const Transitions& rows, const OnStageEnd& on_stage_end) {
  engine_->SetRateFactor(rate_factor_, &optimiser_);
  networks_.Forward(rows.obs_frames, rows.obs_vector);
  engine_->ClippedPolicyLoss({.mean = networks_.mean(),
                              .value = networks_.value(),
                              .drawn_action = rows.drawn_action,
                              .old_log_prob = rows.log_prob,
                              .old_value = old_value_,
                              .advantage = advantage_,
                              .target = target_,
                              .clip = clip_,
                              .value_clip = config_.ppo.value_clip,
                              .value_weight = config_.ppo.value_weight,
                              .entropy_weight = config_.ppo.entropy_weight,
                              .normalise_advantages = config_.ppo.normalise_advantages},
                             networks_.log_std(), mean_gradient_, value_gradient_, numbers_);
  on_stage_end(UpdateStage::kForward);
  networks_.Backward(mean_gradient_, value_gradient_);
  engine_->Gather(&optimiser_, gradient_squares_);
  engine_->RequireFinite(numbers_.total);
  if (config_.ppo.target_kl > 0) {
    engine_->HoldSteps(numbers_.approx_kl, kKlMargin * config_.ppo.target_kl);
  }
  engine_->RequireFinite(numbers_.rounded_total);
  on_stage_end(UpdateStage::kBackward);
  engine_->Step(&optimiser_, networks_.Modules(), NextUse::kNextUpdate);
  engine_->GaussianFigures(*networks_.log_std(), deviation_, entropy_);
  const Engine::Outcome outcome = engine_->EndAndWait();
  on_stage_end(UpdateStage::kOptimiser);
  return outcome;
}

void PpoAgent::AddTo(Sums* sums, const Engine::Outcome& outcome) const {
  ++sums->minibatches;
  sums->policy += engine_->Read(numbers_.policy);
  sums->value += engine_->Read(numbers_.value);
  sums->approx_kl += engine_->Read(numbers_.approx_kl);
  sums->clip_fraction += engine_->Read(numbers_.clip_fraction);
  if (!outcome.finite || outcome.held) return;
  sums->grad_norm += std::sqrt(engine_->Read(gradient_squares_));
  ++sums->steps;
}

bool PpoAgent::Epochs(const BatchView& batch, const Prepared& prepared,
                      const OnStageEnd& on_stage_end, Sums* sums) {
  Random random(StreamKey(uint64_t(config_.seed), StreamRole::kLearnerUpdate, updates_));
  bool over = false;
  for (int epoch = 0; epoch < config_.ppo.epochs && !over; ++epoch) {
    const std::vector<int> rows = order_(prepared.rows, &random);
    const auto size = size_t(batch_size_);
    for (size_t at = 0; at + size <= rows.size() && !over; at += size) {
      const Transitions some = TakeRows(batch, prepared, std::span(rows).subspan(at, size));
      const Engine::Outcome outcome = LearnFrom(some, on_stage_end);
      AddTo(sums, outcome);
      if (!outcome.finite) return false;
      over = outcome.held;
    }
  }
  return true;
}

void PpoAgent::SetFigures(const BatchView& batch, const Prepared& prepared, const Sums& sums,
                          UpdateFigures* figures) const {
  const double seen = std::max(1, sums.minibatches), steps = std::max(1, sums.steps);
  double lag = 0;
  for (const uint64_t update : batch.weights_update) {
    lag += double(updates_ - std::min(update, updates_)) / prepared.rows;
  }
  figures->Set(kActorLoss, sums.policy / seen);
  figures->Set(kValueLoss, sums.value / seen);
  figures->Set(kEntropy, engine_->Read(entropy_));
  figures->Set(kApproxKl, sums.approx_kl / seen);
  figures->Set(kClipFraction, sums.clip_fraction / seen);
  figures->Set(kGradNorm, sums.grad_norm / steps);
  figures->Set(kDeviation, engine_->Read(deviation_));
  figures->Set(kClipRange, engine_->Read(clip_));
  figures->Set(kLearningRate, config_.learner.learning_rate * engine_->Read(rate_factor_));
  figures->Set(kMinibatches, sums.steps);
  figures->Set(kRolloutSteps, prepared.rows);
  figures->Set(kRolloutLag, lag);
  figures->Set(kExplainedVariance, ExplainedVariance(prepared.value, prepared.target));
}

UpdateOutcome PpoAgent::LearnFromRollout(const BatchView& batch, const OnStageEnd& on_stage_end) {
  CHECK(int(batch.reward.size()) >= batch_size_) << "rollout of " << batch.reward.size();
  const nn::ThreadScope scope(engine_->modules().threads);
  UpdateOutcome outcome{.figures = {}, .finite = AllFinite(batch)};
  if (!outcome.finite) return outcome;
  // Kept for a minibatch that is not finite: earlier minibatches have then changed the parameters.
  const nn::TensorMap former = AllTensors();
  const int rows = int(batch.reward.size());
  engine_->Set(clip_, config_.ppo.clip.At(StepsWith(rows)));
  engine_->Set(rate_factor_, config_.learner.rate_factor.At(StepsWith(rows)));
  const Prepared prepared = Prepare(batch);
  on_stage_end(UpdateStage::kForward);
  Sums sums;
  outcome.finite = Epochs(batch, prepared, on_stage_end, &sums);
  SetFigures(batch, prepared, sums, &outcome.figures);
  if (!outcome.finite) {
    Restore(former, "former state");
    return outcome;
  }
  standard_.Add(batch);
  env_steps_ += uint64_t(rows);
  ++updates_;
  on_stage_end(UpdateStage::kOptimiser);
  return outcome;
}

}  // namespace

std::vector<int> ShuffledRows(int rows, Random* random) {
  auto order = std::vector<int>(size_t(rows));
  std::iota(order.begin(), order.end(), 0);
  for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random->Below(i)]);
  return order;
}

std::unique_ptr<Agent> MakePpoAgent(const Config& config, const ObservationSpec& spec,
                                    Engine* engine) {
  return MakePpoAgent(config, spec, engine, ShuffledRows);
}

std::unique_ptr<Agent> MakePpoAgent(const Config& config, const ObservationSpec& spec,
                                    Engine* engine, RowOrder order) {
  return std::make_unique<PpoAgent>(config, spec, engine, std::move(order));
}

}  // namespace shoal::learner
