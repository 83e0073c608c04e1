// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/update_cost.h"

#include <algorithm>

#include "common/config/exploration_kind.h"
#include "common/config/on_policy.h"
#include "common/config/sequences.h"
#include "common/nn/actor_critic_plan.h"
#include "common/nn/latent_plan.h"
#include "learner/agent/algorithms.h"
#include "learner/agent/critic_outputs.h"
#include "learner/agent/critic_vectors.h"

namespace shoal::learner {
namespace {

// Multiply-adds of a layer for one sample.
double MultiplyAdds(const nn::LayerPlan& layer) {
  double count = 0;
  for (const nn::ParameterSpec& parameter : layer.Parameters()) {
    if (parameter.shape.size() < 2) continue;  // biases and norms
    double weights = 1;
    for (const int64_t size : parameter.shape) weights *= double(size);
    count += weights * layer.output.height * layer.output.width;
  }
  return count;
}

double MultiplyAdds(const nn::NetworkPlan& plan) {
  double count = 0;
  for (const nn::LayerPlan& layer : plan.layers()) count += MultiplyAdds(layer);
  return count;
}

double MultiplyAdds(const nn::HeadPlan& head) {
  double count = MultiplyAdds(head.trunk);
  for (const nn::NetworkPlan& mlp : head.mlps) count += MultiplyAdds(mlp);
  return count;
}

// Multiply-adds of an encoder for one sample.
struct EncoderPasses {
  double forward = 0, backward = 0;
};

EncoderPasses PassesOf(const nn::NetworkPlan& encoder) {
  EncoderPasses passes;
  for (const nn::LayerPlan& layer : encoder.layers()) {
    const double count = MultiplyAdds(layer);
    passes.forward += count;
    // The gradients of the weights and of the input each cost as much as the layer itself. Pixels
    // need no gradient.
    const bool reads_pixels =
        layer.source != nn::kNoLayer &&
        encoder.layers()[size_t(layer.source)].kind == nn::LayerPlan::Kind::kPixels;
    passes.backward += reads_pixels ? count : 2 * count;
  }
  return passes;
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

// Multiply-adds of an update.
double OffPolicy(const Config& config, const ObservationSpec& spec, const EncoderPasses& encoder) {
  const int critic_count = CriticsOf(config);
  const nn::ActorPlan actor = nn::PlanActor(
      config.network, spec,
      LearnsDeviation(config) ? nn::ActorOutput::kGaussian : nn::ActorOutput::kDeterministic);
  const nn::HeadPlan critics = nn::PlanCritic(config.network, CriticSpec(config, spec), "critic",
                                              critic_count, CriticOutputs(config));
  const double of_actor = MultiplyAdds(actor), of_critics = MultiplyAdds(critics);
  const bool separate = config.network.encoders == "separate";
  const bool asymmetric = bool(config.sac.critic_blocks);
  const bool actor_trains = separate || asymmetric;
  const int next_encoders = separate || config.network.target_encoder ? 2 : 1;

  double critic_step = next_encoders * encoder.forward + 4 * of_critics + of_actor;
  if (!asymmetric) critic_step += encoder.forward + encoder.backward;
  // The gradient of the action passes through the critics' MLPs, not through their trunk.
  double actor_step = 3 * of_actor + 2 * of_critics - MultiplyAdds(critics.trunk);
  if (separate) actor_step += encoder.forward;  // the critic's encoder
  if (actor_trains) {
    actor_step += encoder.forward + encoder.backward;
  } else {
    actor_step -= MultiplyAdds(actor.trunk);  // the actor does not train the critic's features
  }
  return config.learner.batch *
         (critic_step + actor_step / std::max(1, config.learner.actor_period));
}

double WithModel(const Config& config, const ObservationSpec& spec, const EncoderPasses& encoder) {
  const nn::StatePlan state = nn::PlanState(config.network, spec, "actor");
  const nn::LatentModelPlan model = nn::PlanLatentModel(config.network, spec, "model");
  const double of_state = MultiplyAdds(state.trunk) + MultiplyAdds(state.layers);
  const double of_join = MultiplyAdds(model.action) + MultiplyAdds(model.joint);
  const double of_actor =
      MultiplyAdds(nn::PlanStateActor(config.network, spec, "actor", state.columns()));
  const double of_critics =
      MultiplyAdds(nn::PlanJointCritic(config.network, "critic", model.joint_columns()));
  const int horizon = HorizonOf(config);
  const double encode = encoder.forward + of_state;

  // The states of all steps are targets of the model's loss.
  const double model_step = encode + encoder.backward + 2 * of_state + horizon * encode +
                            3 * horizon * (of_join + MultiplyAdds(model.heads));
  const double targets = encode + of_actor + of_join + of_critics;
  const double critic_step = encode + of_join + 3 * of_critics;
  // The gradient of the action passes through critics and model, not through their weights.
  const double actor_step = 3 * of_actor + 2 * of_join + 2 * of_critics;
  return config.learner.batch * (model_step + targets + critic_step + actor_step);
}

double OnPolicy(const Config& config, const ObservationSpec& spec, const EncoderPasses& encoder) {
  const bool shared = config.ppo.networks == "shared";
  const auto head = [&](const char* name, int outputs) {
    return MultiplyAdds(nn::PlanObservationHead(config.network, spec, name, outputs, 1));
  };
  const double of_actor = head("actor", spec.action_size + (shared ? 1 : 0));
  const double of_value = shared ? of_actor : head("value", 1);
  const double of_heads = shared ? of_actor : of_actor + of_value;
  const int encoders = shared ? 1 : 2;
  const double of_epoch = encoders * (encoder.forward + encoder.backward) + 3 * of_heads;
  const double rows = double(config.ppo.rollout_steps) * config.actors * config.envs_per_actor;
  return rows * (encoder.forward + of_value + config.ppo.epochs * of_epoch);
}

}  // namespace

UpdateCost CostOfUpdate(const Config& config, const ObservationSpec& spec) {
  const nn::NetworkPlan encoder = nn::PlanEncoder(config.network, spec);
  const EncoderPasses passes = PassesOf(encoder);
  const auto count = LearnsOnPolicy(config)  ? OnPolicy
                     : HorizonOf(config) > 0 ? WithModel
                                             : OffPolicy;
  const double multiply_adds = count(config, spec, passes);
  return {.encoder_parameters = ParameterCount(encoder), .flop = 2 * multiply_adds};
}

}  // namespace shoal::learner
