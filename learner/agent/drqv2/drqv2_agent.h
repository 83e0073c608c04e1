// SPDX-License-Identifier: Apache-2.0
// DrQ-v2: two critics, no target actor, and one schedule of noise for the actions of targets and of
// the actor's loss (Yarats et al. 2021, arXiv:2107.09645). The actors explore with the same
// schedule. The rest is in deterministic/deterministic_agent.h.
#pragma once

#include <memory>

#include "learner/agent/deterministic/deterministic_agent.h"

namespace shoal::learner {

// See Algorithm::make.
std::unique_ptr<Agent> MakeDrqv2Agent(const Config& config, const ObservationSpec& spec,
                                      Engine* engine);

}  // namespace shoal::learner
