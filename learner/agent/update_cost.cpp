#include "learner/agent/update_cost.h"

#include <algorithm>

#include "common/nn/actor_critic_plan.h"

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

}  // namespace

UpdateCost CostOfUpdate(const Config& config, const ObservationSpec& spec) {
  const nn::NetworkPlan encoder = nn::PlanEncoder(config.network, spec);
  const int critics = config.learner.algorithm == "ddpg" ? 1 : 2;
  const double of_encoder = MultiplyAdds(encoder);
  const double of_actor = MultiplyAdds(nn::PlanActor(config.network, spec));
  const double of_critics = MultiplyAdds(nn::PlanCritic(config.network, spec, "critic", critics));
  const double critic_step = 4 * of_encoder + 4 * of_critics + of_actor;
  const double actor_step = 3 * of_actor + 2 * of_critics;
  return {.encoder_parameters = ParameterCount(encoder),
          .flop = 2.0 * config.learner.batch *
                  (critic_step + actor_step / std::max(1, config.learner.actor_period))};
}

}  // namespace shoal::learner
