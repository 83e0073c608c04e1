// SPDX-License-Identifier: Apache-2.0
// The cameras of a task: those that its world lists, those that its model names
// (<camera name="overhead">) and those of the configuration.
#pragma once

#include <string>
#include <vector>

#include "actor/worlds/camera_view.h"
#include "actor/worlds/world.h"
#include "common/config/config.h"

namespace shoal::worlds {

// World::cameras(), then the named cameras of the model that have another name.
std::vector<CameraView> CamerasOf(const World& world);

// The camera to look through by default: the first of CamerasOf. Throws Error (kUsage) when there
// is none.
CameraView DefaultCamera(const World& world);

// The camera of that name among CamerasOf; throws Error (kUsage) listing those there are.
CameraView FindCamera(const World& world, const std::string& name);

// The camera of that name: the world's own, or one of observation.custom_cameras, or the model's.
// Throws Error (kUsage) listing those there are, when a custom camera takes a name of the world's
// own, and when the model lacks the body that one is mounted on.
CameraView ChooseCamera(const World& world, const ObservationConfig& observation,
                        const std::string& name);

// Names for the pictures of a run: observation.cameras; where these are the default ones of the
// configuration and the task lacks one of them, the task's default camera alone.
std::vector<std::string> ChooseCameras(const World& world, const ObservationConfig& observation);

// Throws Error (kUsage) if a camera that the world lists is invalid: no name or one that is taken,
// numbers that are not finite, a distance that is not positive, or a number of a camera that the
// model does not have.
void CheckCameras(const World& world);

}  // namespace shoal::worlds
