// One update, in order (equations of docs/algorithm.md):
//
//   1. targets     next_obs -> encoder -> actor, target heads -> y                 (Eq. 5, 15)
//   2. critic      obs -> encoder -> critic heads -> loss -> encoder and critic step   (Eq. 6)
//   3. actor       the features of 2, detached -> actor -> critic heads -> actor step  (Eq. 7)
//   4. temperature from the log-probabilities of 3                                     (Eq. 8)
//   5. target heads follow the critic's                                                (Eq. 9)
//   6. the averaged policy follows encoder and actor                                  (Eq. 12)
//
// 3 and 4 every actor_period updates, 5 every target_period, both from the first update on. The
// encoder keeps one set of activations, so next_obs goes through it first. The temperature in 1 and
// 3 is the one before this update.
#include "learner/sac_agent.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/base/random.h"
#include "common/nn/actor_critic.h"
#include "common/nn/frame_pooling.h"
#include "common/nn/parallel.h"
#include "common/nn/tensor_counter.h"
#include "learner/agent/batch_faults.h"
#include "learner/agent/frozen_cameras.h"
#include "learner/agent/losses.h"
#include "learner/agent/squashed_gaussian.h"

namespace shoal::learner {
namespace {

constexpr const char* kUpdates = "agent.updates";
constexpr int kSpreadFrames = 32;

// Above this, squares of gradients would overflow in Adam's second moment.
bool Usable(float loss, double gradient_squares) {
  return std::isfinite(loss) && gradient_squares < std::numeric_limits<float>::max();
}

}  // namespace

struct SacAgent::Impl {
  Impl(const Config& run_config, const ObservationSpec& observation_spec, nn::Precision precision)
      : config(run_config),
        spec(observation_spec),
        batch_size(run_config.learner.batch),
        target_entropy(float(run_config.learner.target_entropy == 0
                                 ? -observation_spec.action_size
                                 : run_config.learner.target_entropy)),
        threads(nn::Threads()),
        networks(run_config.network, observation_spec, precision,
                 {.batch = batch_size,
                  .seed = uint64_t(run_config.seed),
                  .learning_rate = run_config.learner.learning_rate,
                  .initial_temperature = run_config.learner.initial_temperature}),
        gaussian(batch_size, spec.action_size),
        targets(size_t(batch_size)),
        q_gradients{targets, targets},
        action_gradient(size_t(batch_size) * size_t(spec.action_size)),
        mean_gradient(action_gradient),
        log_std_gradient(action_gradient) {}

  // The time since the last call, or the update's beginning, went into this stage.
  void Spent(double* stage) {
    const SteadyTime now = Now();
    *stage += std::chrono::duration<double>(now - std::exchange(counted_until, now)).count();
  }
  float FrameSpread(const BatchView& batch) const;
  void ComputeTargets(const BatchView& batch, float temperature, Random* random);
  bool UpdateCritic(const BatchView& batch, UpdateStats* stats);
  bool UpdateActor(const BatchView& batch, float temperature, Random* random, UpdateStats* stats);

  const Config config;
  const ObservationSpec spec;
  const int batch_size;  // B
  const float target_entropy;
  const int threads;
  nn::ActorCritic networks;
  uint64_t updates = 0;
  UpdateSeconds seconds;
  SteadyTime counted_until;
  UpdateStats last;  // carries the actor's values to updates without one

  SquashedGaussian gaussian;
  std::vector<float> targets;                                           // y (B)
  std::array<std::vector<float>, 2> q_gradients;                        // (B)
  std::vector<float> action_gradient, mean_gradient, log_std_gradient;  // (B, A)
};

// A batch is a random sample, so its first frames stand for all.
float SacAgent::Impl::FrameSpread(const BatchView& batch) const {
  if (!spec.HasPixels()) return 0;
  return float(nn::MeanFrameSpread(batch.obs_frames.data(), std::min(batch_size, kSpreadFrames),
                                   spec.stack * spec.FrameBytes()));
}

void SacAgent::Impl::ComputeTargets(const BatchView& batch, float temperature, Random* random) {
  const float* vector = batch.next_obs_vector.data();
  networks.Encode(batch.next_obs_frames.data());
  const auto [mean, log_std] = networks.ForwardActor(vector);
  gaussian.Sample(mean, log_std, random);
  const auto [q0, q1] = networks.ForwardTarget(vector, gaussian.action());
  const TargetInputs inputs{
      batch.reward.data(), batch.bootstrap.data(), {q0, q1}, gaussian.log_prob()};
  const TargetRates rates{float(config.learner.reward_scale), float(config.learner.discount),
                          temperature};
  TdTargets(batch_size, inputs, rates, targets.data());
  AverageCopies(batch_size, config.replay.copies, targets.data());
  Spent(&seconds.forward);
}

// False where the loss or its gradient is not finite; then no parameter has changed.
bool SacAgent::Impl::UpdateCritic(const BatchView& batch, UpdateStats* stats) {
  networks.Encode(batch.obs_frames.data());
  const auto [q0, q1] = networks.ForwardCritic(batch.obs_vector.data(), batch.action.data());
  const CriticLoss loss = CriticLossForward(batch_size, q0, q1, targets.data());
  Spent(&seconds.forward);
  CriticLossBackward(batch_size, q0, targets.data(), q_gradients[0].data());
  CriticLossBackward(batch_size, q1, targets.data(), q_gradients[1].data());
  const double squares = networks.BackwardCritic(q_gradients[0].data(), q_gradients[1].data());
  Spent(&seconds.backward);
  stats->critic_loss = loss.loss;
  stats->q_mean = loss.q_mean;
  stats->target_mean = loss.target_mean;
  stats->critic_grad_norm = float(std::sqrt(squares));
  if (!Usable(loss.loss, squares)) return false;
  networks.StepCritic();
  Spent(&seconds.optimiser);
  return true;
}

// The features are still those of obs. False where the loss or its gradient is not finite; then
// neither actor nor temperature has changed.
bool SacAgent::Impl::UpdateActor(const BatchView& batch, float temperature, Random* random,
                                 UpdateStats* stats) {
  const float* vector = batch.obs_vector.data();
  const auto [mean, log_std] = networks.ForwardActor(vector);
  gaussian.Sample(mean, log_std, random);
  const auto [q0, q1] = networks.ForwardCritic(vector, gaussian.action());
  stats->actor_loss = ActorLossForward(batch_size, gaussian.log_prob(), q0, q1, temperature);
  Spent(&seconds.forward);
  ActorLossBackward(batch_size, q0, q1, q_gradients[0].data(), q_gradients[1].data());
  networks.BackwardAction(q_gradients[0].data(), q_gradients[1].data(), action_gradient.data());
  gaussian.Backward(action_gradient.data(), temperature / float(batch_size), mean_gradient.data(),
                    log_std_gradient.data());
  const double squares = networks.BackwardActor(mean_gradient.data(), log_std_gradient.data());
  Spent(&seconds.backward);
  stats->actor_grad_norm = float(std::sqrt(squares));
  stats->entropy = gaussian.Entropy();
  stats->action_saturation = gaussian.Saturation();
  stats->temperature_loss = TemperatureLoss(temperature, stats->entropy, target_entropy);
  if (!Usable(stats->actor_loss, squares) || !std::isfinite(stats->temperature_loss)) return false;
  networks.StepActor();
  networks.StepTemperature(stats->temperature_loss);
  Spent(&seconds.optimiser);
  return true;
}

SacAgent::SacAgent(const Config& config, const ObservationSpec& spec, nn::Precision precision) {
  const nn::ThreadScope scope(nn::Threads());
  impl_ = std::make_unique<Impl>(config, spec, precision);
}

SacAgent::~SacAgent() = default;

UpdateStats SacAgent::Update(const BatchView& batch) {
  Impl& agent = *impl_;
  CHECK(int(batch.reward.size()) == agent.batch_size) << "batch of " << batch.reward.size();
  const nn::ThreadScope scope(agent.threads);
  const LearnerConfig& learner = agent.config.learner;
  agent.counted_until = Now();
  UpdateStats stats = agent.last;
  stats.frame_spread = agent.FrameSpread(batch);
  stats.frozen_cameras =
      float(FrozenCameras(batch.obs_frames, agent.spec, agent.config.replay.shift_pad));
  stats.temperature = agent.networks.Temperature();
  stats.finite = AllFinite(batch);
  if (!stats.finite) return stats;

  Random random(StreamKey(uint64_t(agent.config.seed), StreamRole::kLearnerUpdate, agent.updates));
  const float temperature = agent.networks.Temperature();
  agent.ComputeTargets(batch, temperature, &random);
  stats.finite = agent.UpdateCritic(batch, &stats);
  if (!stats.finite) return stats;
  if (agent.updates % uint64_t(learner.actor_period) == 0 &&
      !agent.UpdateActor(batch, temperature, &random, &stats)) {
    agent.networks.UndoStepCritic();
    stats.finite = false;
    return stats;
  }
  if (agent.updates % uint64_t(learner.target_period) == 0) {
    agent.networks.MoveTarget(float(learner.tau));
  }
  agent.networks.MovePolicyAverage(float(learner.average_rate));
  agent.Spent(&agent.seconds.optimiser);
  ++agent.updates;
  stats.temperature = agent.networks.Temperature();
  agent.last = stats;
  return stats;
}

uint64_t SacAgent::updates() const { return impl_->updates; }

const UpdateSeconds& SacAgent::seconds() const { return impl_->seconds; }

nn::TensorMap SacAgent::PolicyTensors() const { return impl_->networks.PolicyTensors(); }

nn::TensorMap SacAgent::AveragedPolicyTensors() const {
  return impl_->networks.AveragedPolicyTensors();
}

nn::TensorMap SacAgent::AllTensors() const {
  nn::TensorMap tensors = impl_->networks.AllTensors();
  nn::ExportCounter(kUpdates, impl_->updates, &tensors);
  return tensors;
}

void SacAgent::Restore(const nn::TensorMap& tensors, const std::string& source) {
  const nn::ThreadScope scope(impl_->threads);
  const uint64_t updates = nn::ImportCounter(tensors, kUpdates, source);
  impl_->networks.Restore(tensors, source);
  impl_->updates = updates;
}

}  // namespace shoal::learner
