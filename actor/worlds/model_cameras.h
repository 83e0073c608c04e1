// SPDX-License-Identifier: Apache-2.0
// The cameras of a model. A camera is fixed, follows a body (track, trackcom) or turns to a body
// (targetbody).
#pragma once

#include <vector>

#include "actor/worlds/camera_view.h"

struct mjModel_;

namespace shoal::worlds {

// The named cameras, in the model's order. Throws Error if there are none.
std::vector<CameraView> ModelCameras(const mjModel_& model);

// The named cameras, in the model's order; may be empty.
std::vector<CameraView> NamedCameras(const mjModel_& model);

}  // namespace shoal::worlds
