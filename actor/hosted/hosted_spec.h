// SPDX-License-Identifier: Apache-2.0
// Computes the run's observation spec from an environment's description and the run's
// configuration. The functions are pure. The coordinator computes the spec before it starts
// processes, and each actor computes the spec again from its own environment. If the spaces differ
// between processes, the hashes of the specs differ and the environment is refused.
#pragma once

#include <string>
#include <vector>

#include "common/config/config.h"
#include "common/spec/observation_spec.h"
#include "common/tasks/environment_description.h"

namespace shoal::hosted {

// Names of the arrays that are images, in the description's order. Each image is a camera of the
// environment.
std::vector<std::string> ImagesOf(const tasks::EnvironmentDescription& environment);

// The images listed in observation.cameras become frames; if that key has its default value, all
// images do. Other arrays become blocks. Without pixels the policy sees all blocks, otherwise the
// blocks of observation.proprioception. Throws Error (kUsage) naming the key or the array if there
// are pixels without images, images of different kinds, or keys that only apply to Shoal's worlds.
ObservationSpec SpecOf(const tasks::EnvironmentDescription& environment, const Config& config);

}  // namespace shoal::hosted
