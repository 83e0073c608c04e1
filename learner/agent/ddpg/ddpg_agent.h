// SPDX-License-Identifier: Apache-2.0
// DDPG: one critic, and targets from the target actor's action without noise (Lillicrap et al.
// 2015, arXiv:1509.02971). The rest is in deterministic/deterministic_agent.h.
#pragma once

#include <memory>

#include "learner/agent/deterministic/deterministic_agent.h"

namespace shoal::learner {

// See Algorithm::make.
std::unique_ptr<Agent> MakeDdpgAgent(const Config& config, const ObservationSpec& spec,
                                     Engine* engine);

}  // namespace shoal::learner
