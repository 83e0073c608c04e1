// SPDX-License-Identifier: Apache-2.0
// Options of an agent's optimisers: the learning rates of actor, critic and temperature, and the
// clipping of gradients.
#pragma once

#include "common/config/config.h"
#include "common/nn/adam.h"

namespace shoal::learner {

// Returns the learning rate `own`, or learner.learning_rate if `own` is 0.
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
