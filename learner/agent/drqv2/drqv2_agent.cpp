// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/drqv2/drqv2_agent.h"

namespace shoal::learner {

std::unique_ptr<Agent> MakeDrqv2Agent(const Config& config, const ObservationSpec& spec,
                                      Engine* engine) {
  return MakeDeterministicAgent(config, spec,
                                {.critics = 2,
                                 .actor_critics = 2,
                                 .target_actor = false,
                                 .noise = config.drqv2.noise,
                                 .noise_clip = config.drqv2.noise_clip,
                                 .noisy_actor_loss = true},
                                engine);
}

}  // namespace shoal::learner
