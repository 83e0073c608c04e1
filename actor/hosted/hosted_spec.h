// SPDX-License-Identifier: Apache-2.0
// From an environment's description and a run's configuration to the run's observation spec. Pure:
// the coordinator computes it before anything is started, and each actor again from the environment
// that it has, so that an environment whose spaces differ between processes is refused by hash.
#pragma once

#include <string>
#include <vector>

#include "common/config/config.h"
#include "common/spec/observation_spec.h"
#include "common/tasks/environment_description.h"

namespace shoal::hosted {

// Names of the arrays that are images, in the description's order: the cameras of the environment.
std::vector<std::string> ImagesOf(const tasks::EnvironmentDescription& environment);

// Images become frames through observation.cameras, which must name images of the environment, or,
// if it is the default, all of them. Other arrays become blocks; without pixels the policy sees all
// of them, otherwise those of observation.proprioception. Throws Error (kUsage) naming the key or
// the array: pixels without images, images of different kinds, keys that belong to Shoal's worlds.
ObservationSpec SpecOf(const tasks::EnvironmentDescription& environment, const Config& config);

}  // namespace shoal::hosted
