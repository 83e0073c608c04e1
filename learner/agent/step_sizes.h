// SPDX-License-Identifier: Apache-2.0
// Step sizes of an agent's optimisers: the learning rates of its parts, and the clipping of
// gradients.
#pragma once

#include "common/config/config.h"
#include "common/nn/adam.h"

namespace shoal::learner {

inline double RateOr(double own, const LearnerConfig& learner) {
  return own > 0 ? own : learner.learning_rate;
}

inline nn::Adam::Options ActorStep(const LearnerConfig& learner) {
  return {.rate = RateOr(learner.actor_learning_rate, learner), .max_norm = learner.max_grad_norm};
}
// Options of the optimiser of the critic and of the encoder.
inline nn::Adam::Options CriticStep(const LearnerConfig& learner) {
  return {.rate = RateOr(learner.critic_learning_rate, learner), .max_norm = learner.max_grad_norm};
}
inline double TemperatureRate(const Config& config) {
  return RateOr(config.sac.temperature_learning_rate, config.learner);
}

}  // namespace shoal::learner
