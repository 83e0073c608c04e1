// TD3: two critics, smoothed targets, an actor that moves less often than they do (Fujimoto et al.
// 2018, arXiv:1802.09477). Everything else: deterministic/deterministic_agent.h.
#pragma once

#include <memory>

#include "learner/agent/deterministic/deterministic_agent.h"

namespace shoal::learner {

// Of the noise on a target's action, as in the source (table 3): standard deviation, and what it is
// clipped to.
inline constexpr double kTd3TargetNoise = 0.2, kTd3TargetNoiseClip = 0.5;

// As Algorithm::make_replica.
std::unique_ptr<Agent> MakeTd3Agent(const Config& config, const ObservationSpec& spec,
                                    nn::Precision precision, nn::Replica* replica);

}  // namespace shoal::learner
