// DDPG with several critics, whose mean is the target: each critic errs for itself, and the mean
// errs less (Anschel et al. 2017, arXiv:1611.01929, there for Q-learning).
//
//   y        = reward_scale r + bootstrap discount mean_k Q'_k(o', mu'(o'))
//   L_critic = sum_k mean_b (Q_k(o, a) - y)^2
//   L_actor  = -mean_b Q_1(o, mu(o))
//
// The worked example of docs/own_algorithm.md.
#pragma once

#include <memory>

#include "common/config/config.h"
#include "common/spec/observation_spec.h"
#include "learner/agent/agent.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

inline constexpr Figure kCriticSpread{"critic_spread", "", "standard deviation between the critics",
                                      false, ""};

// In the order of an update.
inline constexpr const Figure* kAveragedDdpgFigures[] = {
    &kCriticLoss, &kQMean, &kTargetMean, &kCriticSpread, &kCriticGradNorm, &kActorLoss};

// Borrows the engine. Seed, rates, discount and reward scale of `config`.
std::unique_ptr<Agent> MakeAveragedDdpgAgent(const Config& config, const ObservationSpec& spec,
                                             Engine* engine);

}  // namespace shoal::learner
