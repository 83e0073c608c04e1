#include "learner/agent/update_cost.h"

#include <algorithm>

#include "common/config/exploration_kind.h"
#include "common/config/on_policy.h"
#include "common/nn/actor_critic_plan.h"
#include "learner/agent/algorithms.h"
#include "learner/agent/critic_vectors.h"

namespace shoal::learner {
namespace {

// Of one sample.
double MultiplyAdds(const nn::NetworkPlan& plan) {
  double count = 0;
  for (const nn::LayerPlan& layer : plan.layers()) {
    for (const nn::ParameterSpec& parameter : layer.Parameters()) {
      if (parameter.shape.size() < 2) continue;  // a bias, a norm
      double weights = 1;
      for (const int64_t size : parameter.shape) weights *= static_cast<double>(size);
      count += weights * layer.output.height * layer.output.width;
    }
  }
  return count;
}

double MultiplyAdds(const nn::HeadPlan& head) {
  double count = MultiplyAdds(head.trunk);
  for (const nn::NetworkPlan& mlp : head.mlps) count += MultiplyAdds(mlp);
  return count;
}

int64_t ParameterCount(const nn::NetworkPlan& plan) {
  int64_t count = 0;
  for (const nn::ParameterSpec& parameter : plan.Parameters()) {
    int64_t size = 1;
    for (const int64_t side : parameter.shape) size *= side;
    count += size;
  }
  return count;
}

// Multiply-adds of an update; `of_encoder`: of one sample.
double OffPolicy(const Config& config, const ObservationSpec& spec, double of_encoder) {
  const int critics = FindAlgorithm(config.learner.algorithm).critics;
  const double of_actor = MultiplyAdds(nn::PlanActor(
      config.network, spec,
      LearnsDeviation(config) ? nn::ActorOutput::kGaussian : nn::ActorOutput::kDeterministic));
  const double of_critics = MultiplyAdds(
      nn::PlanCritic(config.network, CriticSpec(config.learner, spec), "critic", critics));
  const bool separate = config.network.encoders == "separate";
  const bool asymmetric = bool(config.learner.critic_blocks);
  const int next_encoders = separate || config.network.target_encoder ? 2 : 1;
  const int critic_encoders = next_encoders + (asymmetric ? 0 : 3);
  const int actor_encoders = separate ? 4 : asymmetric ? 3 : 0;
  const double critic_step = critic_encoders * of_encoder + 4 * of_critics + of_actor;
  const double actor_step = actor_encoders * of_encoder + 3 * of_actor + 2 * of_critics;
  return config.learner.batch *
         (critic_step + actor_step / std::max(1, config.learner.actor_period));
}

double OnPolicy(const Config& config, const ObservationSpec& spec, double of_encoder) {
  const bool shared = config.ppo.networks == "shared";
  const auto head = [&](const char* name, int outputs) {
    return MultiplyAdds(nn::PlanObservationHead(config.network, spec, name, outputs, 1));
  };
  const double of_actor = of_encoder + head("actor", spec.action_size + (shared ? 1 : 0));
  const double of_value = shared ? of_actor : of_encoder + head("value", 1);
  const double of_both = shared ? of_actor : of_actor + of_value;
  const double rows = double(config.ppo.rollout_steps) * config.actors * config.envs_per_actor;
  return rows * (of_value + 3 * config.ppo.epochs * of_both);
}

}  // namespace

UpdateCost CostOfUpdate(const Config& config, const ObservationSpec& spec) {
  const nn::NetworkPlan encoder = nn::PlanEncoder(config.network, spec);
  const double of_encoder = MultiplyAdds(encoder);
  const double multiply_adds = LearnsOnPolicy(config) ? OnPolicy(config, spec, of_encoder)
                                                      : OffPolicy(config, spec, of_encoder);
  return {.encoder_parameters = ParameterCount(encoder), .flop = 2 * multiply_adds};
}

}  // namespace shoal::learner
