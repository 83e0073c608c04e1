// SPDX-License-Identifier: Apache-2.0
#include "actor/acting/exploration.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/config/exploration_kind.h"

namespace shoal::actor {
namespace {

// Noise that keeps no state between steps.
class Memoryless : public Exploration {
 public:
  void BeginEpisode(int) override {}
  std::vector<double> StateOf(int) const override { return {}; }
  void SetState(int, std::span<const double> state) override {
    if (!state.empty()) {
      throw RuntimeError("the actor's state has {} numbers of its noise, expected none",
                         state.size());
    }
  }
};

class SquashedGaussian final : public Memoryless {
 public:
  explicit SquashedGaussian(float factor) : factor_(factor) {}

  void OnEnvSteps(uint64_t) override {}
  void Act(int, const nn::PolicyOutput& policy, Random& stream, std::span<float> action) override {
    CHECK(policy.log_std.size() == action.size()) << "a deterministic policy";
    for (size_t a = 0; a < action.size(); ++a) {
      const float noise = factor_ * static_cast<float>(stream.Normal());
      action[a] = std::tanh(policy.mean[a] + std::exp(policy.log_std[a]) * noise);
    }
  }

 private:
  const float factor_;
};

float Bounded(float action) { return std::clamp(action, -1.0F, 1.0F); }

class Gaussian final : public Memoryless {
 public:
  Gaussian(const Schedule& sigma, double factor) : sigma_(sigma), factor_(factor) { OnEnvSteps(0); }

  void OnEnvSteps(uint64_t run_env_steps) override {
    now_ = static_cast<float>(factor_ * sigma_.At(run_env_steps));
  }
  void Act(int, const nn::PolicyOutput& policy, Random& stream, std::span<float> action) override {
    for (size_t a = 0; a < action.size(); ++a) {
      const float noise = now_ * static_cast<float>(stream.Normal());
      action[a] = Bounded(std::tanh(policy.mean[a]) + noise);
    }
  }

 private:
  const Schedule sigma_;
  const double factor_;
  float now_ = 0;
};

// The distribution of an on-policy algorithm. No factor scales its deviation, because the recorded
// log-probability belongs to the policy itself.
class PolicyDraw final : public Memoryless {
 public:
  void OnEnvSteps(uint64_t) override {}
  void Act(int, const nn::PolicyOutput& policy, Random& stream, std::span<float> action) override {
    CHECK(policy.log_std.size() == action.size()) << "a deterministic policy";
    drawn_.resize(action.size());
    double log_prob = 0;
    for (size_t a = 0; a < action.size(); ++a) {
      const double noise = stream.Normal();
      drawn_[a] = policy.mean[a] + std::exp(policy.log_std[a]) * static_cast<float>(noise);
      log_prob -= noise * noise / 2 + policy.log_std[a] + kHalfLogTwoPi;
      action[a] = Bounded(drawn_[a]);
    }
    log_prob_ = static_cast<float>(log_prob);
  }
  float Drawn(std::span<float> drawn) const override {
    std::ranges::copy(drawn_, drawn.begin());
    return log_prob_;
  }

 private:
  static constexpr double kHalfLogTwoPi = 0.91893853320467274;
  std::vector<float> drawn_;
  float log_prob_ = 0;
};

class OrnsteinUhlenbeck final : public Exploration {
 public:
  OrnsteinUhlenbeck(const ExplorationConfig& config, const Schedule& sigma, double factor, int envs,
                    int action_size)
      : config_(config),
        sigma_(sigma),
        factor_(factor),
        noise_(static_cast<size_t>(envs),
               std::vector<double>(static_cast<size_t>(action_size), 0.0)) {
    OnEnvSteps(0);
  }

  void OnEnvSteps(uint64_t run_env_steps) override {
    step_deviation_ = factor_ * sigma_.At(run_env_steps) * std::sqrt(config_.dt);
  }
  void BeginEpisode(int e) override { std::ranges::fill(noise_[static_cast<size_t>(e)], 0.0); }
  void Act(int e, const nn::PolicyOutput& policy, Random& stream,
           std::span<float> action) override {
    std::vector<double>& x = noise_[static_cast<size_t>(e)];
    for (size_t a = 0; a < action.size(); ++a) {
      x[a] += -config_.theta * config_.dt * x[a] + step_deviation_ * stream.Normal();
      action[a] = Bounded(std::tanh(policy.mean[a]) + static_cast<float>(x[a]));
    }
  }
  std::vector<double> StateOf(int e) const override { return noise_[static_cast<size_t>(e)]; }
  void SetState(int e, std::span<const double> state) override {
    if (state.size() != noise_[static_cast<size_t>(e)].size()) {
      throw RuntimeError("the actor's state has {} numbers of its noise, expected {}", state.size(),
                         noise_[static_cast<size_t>(e)].size());
    }
    noise_[static_cast<size_t>(e)].assign(state.begin(), state.end());
  }

 private:
  const ExplorationConfig config_;
  const Schedule sigma_;
  const double factor_;
  double step_deviation_ = 0;
  std::vector<std::vector<double>> noise_;  // (E, A)
};

// Another exploration, with random actions in a share of the steps.
class RandomShare final : public Exploration {
 public:
  RandomShare(double share, std::unique_ptr<Exploration> other)
      : share_(share), other_(std::move(other)) {}

  void OnEnvSteps(uint64_t run_env_steps) override { other_->OnEnvSteps(run_env_steps); }
  void BeginEpisode(int e) override { other_->BeginEpisode(e); }
  void Act(int e, const nn::PolicyOutput& policy, Random& stream,
           std::span<float> action) override {
    if (stream.Uniform() < share_) {
      ActAtRandom(stream, action);
    } else {
      other_->Act(e, policy, stream, action);
    }
  }
  std::vector<double> StateOf(int e) const override { return other_->StateOf(e); }
  void SetState(int e, std::span<const double> state) override { other_->SetState(e, state); }

 private:
  const double share_;
  const std::unique_ptr<Exploration> other_;
};

std::unique_ptr<Exploration> MakeNoise(const Config& config, int envs, int action_size,
                                       double factor) {
  const Schedule& sigma = ExplorationSigma(config);
  switch (ExplorationKindOf(config)) {
    case ExplorationKind::kSquashedGaussian:
      return std::make_unique<SquashedGaussian>(static_cast<float>(factor));
    case ExplorationKind::kGaussian:
      return std::make_unique<Gaussian>(sigma, factor);
    case ExplorationKind::kPolicy:
      return std::make_unique<PolicyDraw>();
    case ExplorationKind::kOrnsteinUhlenbeck:
      return std::make_unique<OrnsteinUhlenbeck>(config.exploration, sigma, factor, envs,
                                                 action_size);
  }
  CHECK(false) << "an exploration without a class";
  return nullptr;
}

}  // namespace

void ActAtRandom(Random& stream, std::span<float> action) {
  for (float& a : action) a = static_cast<float>(stream.Uniform(-1.0, 1.0));
}

std::unique_ptr<Exploration> MakeExploration(const Config& config, int envs, int action_size,
                                             double factor) {
  auto noise = MakeNoise(config, envs, action_size, factor);
  const double share = config.exploration.random_share;
  if (share == 0) return noise;  // draws no number for a share of nothing
  return std::make_unique<RandomShare>(share, std::move(noise));
}

double NoiseFactor(const Config& config, uint32_t actor) {
  if (config.actors < 2) return 1;
  const auto actors = static_cast<uint32_t>(config.actors);
  const double place = static_cast<double>(actor % actors) / (actors - 1);  // 0 .. 1
  return std::pow(config.exploration.spread, 2 * place - 1);
}

uint64_t RandomStepsOfActor(const Config& config) {
  const int64_t actors = std::max(config.actors, 1);
  return static_cast<uint64_t>((config.exploration.random_steps + actors - 1) / actors);
}

}  // namespace shoal::actor
