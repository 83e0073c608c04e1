// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/td3/td3_agent.h"

namespace shoal::learner {

std::unique_ptr<Agent> MakeTd3Agent(const Config& config, const ObservationSpec& spec,
                                    Engine* engine) {
  return MakeDeterministicAgent(config, spec,
                                {.critics = 2,
                                 .noise = Schedule::Constant(config.td3.target_noise),
                                 .noise_clip = config.td3.target_noise_clip},
                                engine);
}

}  // namespace shoal::learner
