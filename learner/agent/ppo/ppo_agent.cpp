// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/ppo/ppo_agent.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <utility>

#include "common/base/check.h"
#include "common/nn/adam.h"
#include "common/nn/host_memory.h"
#include "common/nn/parallel.h"
#include "learner/agent/agent_state.h"
#include "learner/agent/ppo/advantages.h"
#include "learner/agent/ppo/ppo_loss.h"
#include "learner/agent/ppo/ppo_networks.h"
#include "learner/agent/ppo/reward_scale.h"
#include "learner/agent/vector_standard.h"
#include "learner/engine/batch_faults.h"

namespace shoal::learner {
namespace {

constexpr double kAdamEpsilon = 1e-5;
constexpr double kKlMargin = 1.5;  // an update ends beyond so many times target_kl

// Sums over the minibatches of an update.
struct Sums {
  double policy = 0, value = 0, approx_kl = 0, clip_fraction = 0, grad_norm = 0;
  int steps = 0;        // of the optimiser
  int minibatches = 0;  // looked at
};

class PpoAgent final : public Agent {
 public:
  PpoAgent(const Config& config, const ObservationSpec& spec, Engine* engine, RowOrder order);

  UpdateOutcome Update(const BatchView& batch, const OnStageEnd& on_stage_end) override;
  uint64_t updates() const override { return updates_; }
  nn::TensorMap PolicyTensors() const override;
  nn::TensorMap AveragedPolicyTensors() const override { return PolicyTensors(); }
  nn::TensorMap AllTensors() const override { return state_.Export(); }
  void Restore(const nn::TensorMap& tensors, const std::string& source) override {
    state_.Restore(tensors, source);
  }

 private:
  // A rollout and what is computed of it before the first minibatch.
  struct Prepared {
    int rows = 0;                  // N
    std::vector<float> reward;     // (N)
    std::vector<float> value;      // (N)
    std::vector<float> advantage;  // (N)
    std::vector<float> target;     // (N)
  };

  Prepared Prepare(const BatchView& batch);
  // V of these rows of observations; the other rows of the result stay 0.
  std::vector<float> Values(std::span<const uint8_t> frames, std::span<const float> vectors,
                            const std::vector<int>& rows, int count);
  // Copies rows into the minibatch's inputs; the rest of the minibatch keeps what it held.
  void GatherInputs(std::span<const uint8_t> frames, std::span<const float> vectors,
                    std::span<const int> rows);
  // False: not finite. Sets `over` when the policy has moved too far.
  bool Minibatch(const BatchView& batch, const Prepared& prepared, std::span<const int> rows,
                 const OnStageEnd& on_stage_end, Sums* sums, bool* over);
  bool Epochs(const BatchView& batch, const Prepared& prepared, const OnStageEnd& on_stage_end,
              Sums* sums);
  void SetFigures(const BatchView& batch, const Prepared& prepared, const Sums& sums,
                  UpdateFigures* figures);
  uint64_t StepsWith(int rows) const { return env_steps_ + uint64_t(rows); }

  const Config config_;
  const int batch_size_, action_size_, vector_size_;  // B, A, V
  const size_t frame_bytes_;                          // of a stack
  const RowOrder order_;
  const nn::ModuleContext context_;
  PpoNetworks networks_;
  nn::Adam optimiser_;
  VectorStandard standard_;
  RewardScale rewards_;
  uint64_t updates_ = 0;
  uint64_t env_steps_ = 0;  // learned from: the time of schedules
  double clip_ = 0;
  AgentState state_;

  // A minibatch's rows.
  std::vector<uint8_t> frames_;                               // (B, K*C, H, W)
  std::vector<float> vectors_, drawn_;                        // (B, V), (B, A)
  std::vector<float> log_prob_, value_, advantage_, target_;  // (B)
};

PpoAgent::PpoAgent(const Config& config, const ObservationSpec& spec, Engine* engine,
                   RowOrder order)
    : config_(config),
      batch_size_(config.learner.batch),
      action_size_(spec.action_size),
      vector_size_(spec.VectorSize()),
      frame_bytes_(size_t(spec.InputBytes())),
      order_(std::move(order)),
      context_(engine->modules()),
      networks_(config, spec, context_),
      optimiser_(networks_.Sets(),
                 {.rate = config.learner.learning_rate,
                  .epsilon = kAdamEpsilon,
                  .max_norm = config.learner.max_grad_norm},
                 context_),
      standard_(config.learner, vector_size_),
      rewards_(config.learner.discount),
      frames_(size_t(batch_size_) * frame_bytes_),
      vectors_(size_t(batch_size_) * size_t(vector_size_)),
      drawn_(size_t(batch_size_) * size_t(action_size_)),
      log_prob_(size_t(batch_size_)),
      value_(log_prob_),
      advantage_(log_prob_),
      target_(log_prob_) {
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

void PpoAgent::GatherInputs(std::span<const uint8_t> frames, std::span<const float> vectors,
                            std::span<const int> rows) {
  const auto width = size_t(vector_size_);
  for (size_t b = 0; b < rows.size(); ++b) {
    const auto row = size_t(rows[b]);
    if (frame_bytes_ > 0) {
      std::memcpy(frames_.data() + b * frame_bytes_, frames.data() + row * frame_bytes_,
                  frame_bytes_);
    }
    std::copy_n(vectors.data() + row * width, width, vectors_.data() + b * width);
  }
}

std::vector<float> PpoAgent::Values(std::span<const uint8_t> frames, std::span<const float> vectors,
                                    const std::vector<int>& rows, int count) {
  auto values = std::vector<float>(size_t(count));
  for (size_t at = 0; at < rows.size(); at += size_t(batch_size_)) {
    const auto some = std::span(rows).subspan(at, std::min(rows.size() - at, size_t(batch_size_)));
    GatherInputs(frames, vectors, some);
    networks_.ForwardValue(nn::HostArray(frames_), nn::HostArray(vectors_));
    for (size_t b = 0; b < some.size(); ++b) values[size_t(some[b])] = networks_.value()[b];
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

  std::vector<int> ends;  // where the next row is no next observation
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

bool PpoAgent::Minibatch(const BatchView& batch, const Prepared& prepared,
                         std::span<const int> rows, const OnStageEnd& on_stage_end, Sums* sums,
                         bool* over) {
  GatherInputs(batch.obs_frames, batch.obs_vector, rows);
  const auto actions = size_t(action_size_);
  for (size_t b = 0; b < rows.size(); ++b) {
    const auto row = size_t(rows[b]);
    std::copy_n(batch.drawn_action.data() + row * actions, actions, drawn_.data() + b * actions);
    log_prob_[b] = batch.log_prob[row];
    value_[b] = prepared.value[row];
    advantage_[b] = prepared.advantage[row];
    target_[b] = prepared.target[row];
  }
  networks_.Forward(nn::HostArray(frames_), nn::HostArray(vectors_));
  const PpoLoss loss =
      PpoLossAndGradients({.batch = batch_size_,
                           .action_size = action_size_,
                           .mean = networks_.mean(),
                           .log_std = networks_.log_std(),
                           .value = networks_.value(),
                           .drawn_action = drawn_,
                           .old_log_prob = log_prob_,
                           .old_value = value_,
                           .advantage = advantage_,
                           .target = target_,
                           .clip = clip_,
                           .value_clip = config_.ppo.value_clip,
                           .value_weight = config_.ppo.value_weight,
                           .entropy_weight = config_.ppo.entropy_weight,
                           .normalise_advantages = config_.ppo.normalise_advantages},
                          {.mean = networks_.mean_gradient(),
                           .log_std = networks_.log_std_gradient(),
                           .value = networks_.value_gradient()});
  on_stage_end(UpdateStage::kForward);
  ++sums->minibatches;
  sums->policy += loss.policy;
  sums->value += loss.value;
  sums->approx_kl += loss.approx_kl;
  sums->clip_fraction += loss.clip_fraction;
  if (!std::isfinite(loss.total)) return false;
  const double target_kl = config_.ppo.target_kl;
  *over = target_kl > 0 && loss.approx_kl > kKlMargin * target_kl;
  if (*over) return true;
  networks_.Backward();
  const double squares = optimiser_.GatherGradients();
  on_stage_end(UpdateStage::kBackward);
  if (!std::isfinite(float(loss.total)) || !FitsMoments(squares)) return false;
  sums->grad_norm += std::sqrt(squares);
  optimiser_.Step();
  networks_.Refresh();
  ++sums->steps;
  on_stage_end(UpdateStage::kOptimiser);
  return true;
}

bool PpoAgent::Epochs(const BatchView& batch, const Prepared& prepared,
                      const OnStageEnd& on_stage_end, Sums* sums) {
  Random random(StreamKey(uint64_t(config_.seed), StreamRole::kLearnerUpdate, updates_));
  bool over = false;
  for (int epoch = 0; epoch < config_.ppo.epochs && !over; ++epoch) {
    const std::vector<int> rows = order_(prepared.rows, &random);
    const auto size = size_t(batch_size_);
    for (size_t at = 0; at + size <= rows.size() && !over; at += size) {
      if (!Minibatch(batch, prepared, std::span(rows).subspan(at, size), on_stage_end, sums,
                     &over)) {
        return false;
      }
    }
  }
  return true;
}

void PpoAgent::SetFigures(const BatchView& batch, const Prepared& prepared, const Sums& sums,
                          UpdateFigures* figures) {
  const double seen = std::max(1, sums.minibatches), steps = std::max(1, sums.steps);
  double deviation = 0, entropy = 0, lag = 0;
  for (const float log_std : networks_.log_std()) {
    deviation += std::exp(double{log_std}) / action_size_;
    entropy += double{log_std} + 1.4189385332046727;  // log(2 pi e) / 2
  }
  for (const uint64_t update : batch.weights_update) {
    lag += double(updates_ - std::min(update, updates_)) / prepared.rows;
  }
  figures->Set(kActorLoss, sums.policy / seen);
  figures->Set(kValueLoss, sums.value / seen);
  figures->Set(kEntropy, entropy);
  figures->Set(kApproxKl, sums.approx_kl / seen);
  figures->Set(kClipFraction, sums.clip_fraction / seen);
  figures->Set(kGradNorm, sums.grad_norm / steps);
  figures->Set(kDeviation, deviation);
  figures->Set(kClipRange, clip_);
  figures->Set(kLearningRate, optimiser_.rate());
  figures->Set(kMinibatches, sums.steps);
  figures->Set(kRolloutSteps, prepared.rows);
  figures->Set(kRolloutLag, lag);
  figures->Set(kExplainedVariance, ExplainedVariance(prepared.value, prepared.target));
}

UpdateOutcome PpoAgent::Update(const BatchView& batch, const OnStageEnd& on_stage_end) {
  CHECK(int(batch.reward.size()) >= batch_size_) << "rollout of " << batch.reward.size();
  const nn::ThreadScope scope(context_.threads);
  UpdateOutcome outcome{.figures = {}, .finite = AllFinite(batch)};
  if (!outcome.finite) return outcome;
  // Minibatches before one that is not finite have changed it all.
  const nn::TensorMap former = AllTensors();
  const int rows = int(batch.reward.size());
  clip_ = config_.ppo.clip.At(StepsWith(rows));
  optimiser_.set_rate_factor(config_.learner.rate_factor.At(StepsWith(rows)));
  const BatchView seen = standard_.Seen(batch);
  const Prepared prepared = Prepare(seen);
  on_stage_end(UpdateStage::kForward);
  Sums sums;
  outcome.finite = Epochs(seen, prepared, on_stage_end, &sums);
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
