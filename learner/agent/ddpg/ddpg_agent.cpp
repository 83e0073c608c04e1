// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/ddpg/ddpg_agent.h"

namespace shoal::learner {

std::unique_ptr<Agent> MakeDdpgAgent(const Config& config, const ObservationSpec& spec,
                                     nn::Precision precision, nn::Replica* replica) {
  return MakeDeterministicAgent(config, spec, precision, {.critics = 1}, replica);
}

}  // namespace shoal::learner
