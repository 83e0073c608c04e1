// SPDX-License-Identifier: Apache-2.0
// The cameras that a model brings itself: fixed, following a body (track, trackcom) or turning to
// it (targetbody).
#pragma once

#include <vector>

#include "actor/worlds/camera_view.h"

struct mjModel_;

namespace shoal::worlds {

// The named ones, in the model's order. Throws Error when there is none.
std::vector<CameraView> ModelCameras(const mjModel_& model);

// The same; empty when there is none.
std::vector<CameraView> NamedCameras(const mjModel_& model);

}  // namespace shoal::worlds
