// SPDX-License-Identifier: Apache-2.0
// The cameras of a task: the cameras that its world lists, the named cameras of its model
// (<camera name="overhead">) and the cameras of the configuration.
#pragma once

#include <string>
#include <vector>

#include "actor/worlds/camera_view.h"
#include "actor/worlds/world.h"
#include "common/config/config.h"

namespace shoal::worlds {

// All cameras of World::cameras(), then those named cameras of the model whose names
// World::cameras() does not use.
std::vector<CameraView> CamerasOf(const World& world);

// The default camera: the first of CamerasOf. Throws Error (kUsage) if there is none.
CameraView DefaultCamera(const World& world);

// The camera `name` of CamerasOf. Throws Error (kUsage) listing the known cameras.
CameraView FindCamera(const World& world, const std::string& name);

// The camera `name`: one of the world, of observation.custom_cameras or of the model. Throws Error
// (kUsage) if there is no such camera (the message lists the known cameras), if a custom camera has
// the name of a camera of the world, and if the model lacks the body on which a camera is mounted.
CameraView ChooseCamera(const World& world, const ObservationConfig& observation,
                        const std::string& name);

// Names of a run's cameras: observation.cameras. If that key has its default value and the task
// lacks one of the named cameras, the result is the task's default camera alone.
std::vector<std::string> ChooseCameras(const World& world, const ObservationConfig& observation);

// Throws Error (kUsage) if a camera of World::cameras() is invalid: if it has no name or a
// duplicate name, numbers that are not finite, a distance that is not positive, or the number of a
// camera that the model does not have.
void CheckCameras(const World& world);

}  // namespace shoal::worlds
