// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/ddpg/ddpg_agent.h"

namespace shoal::learner {

std::unique_ptr<Agent> MakeDdpgAgent(const Config& config, const ObservationSpec& spec,
                                     Engine* engine) {
  return MakeDeterministicAgent(config, spec, {.critics = 1}, engine);
}

}  // namespace shoal::learner
