// SPDX-License-Identifier: Apache-2.0
// Cameras of the user's beside those of a task.
#pragma once

#include <string>

#include "actor/worlds/camera_view.h"
#include "actor/worlds/world.h"
#include "common/config/config.h"

namespace shoal::worlds {

// The camera of that name, the world's own or one of observation.custom_cameras. Throws Error
// (kUsage) listing those there are, when a custom camera takes a name of the world's own, and when
// the model lacks the body that one is mounted on.
CameraView ChooseCamera(const World& world, const ObservationConfig& observation,
                        const std::string& name);

}  // namespace shoal::worlds
