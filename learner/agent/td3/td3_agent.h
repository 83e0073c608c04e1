// SPDX-License-Identifier: Apache-2.0
// TD3: two critics, smoothed targets, and an actor that is updated less often than the critics
// (Fujimoto et al. 2018, arXiv:1802.09477). The rest is in deterministic/deterministic_agent.h.
#pragma once

#include <memory>

#include "learner/agent/deterministic/deterministic_agent.h"

namespace shoal::learner {

// See Algorithm::make.
std::unique_ptr<Agent> MakeTd3Agent(const Config& config, const ObservationSpec& spec,
                                    Engine* engine);

}  // namespace shoal::learner
