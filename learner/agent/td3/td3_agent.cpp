// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/td3/td3_agent.h"

namespace shoal::learner {

std::unique_ptr<Agent> MakeTd3Agent(const Config& config, const ObservationSpec& spec,
                                    nn::Precision precision, nn::Replica* replica) {
  return MakeDeterministicAgent(config, spec, precision,
                                {.critics = 2,
                                 .target_noise = config.td3.target_noise,
                                 .target_noise_clip = config.td3.target_noise_clip},
                                replica);
}

}  // namespace shoal::learner
