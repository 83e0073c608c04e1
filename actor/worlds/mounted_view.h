// SPDX-License-Identifier: Apache-2.0
// Views that move with a body of the model.
#pragma once

#include "actor/worlds/camera_view.h"

struct mjData_;
struct mjModel_;
struct mjvScene_;

namespace shoal::worlds {

// If the model lacks the body of a mounted view, throws Error (kUsage) naming camera and body.
// Accepts views that are not mounted.
void CheckMount(const mjModel_& model, const CameraView& camera);

// Moves the scene's camera and headlight to the present pose of the mounted `camera`. Before this
// call, the scene has been updated with a free camera; the field of view of the free camera is
// kept. CHECK: CheckMount passes.
void MountCamera(const mjModel_& model, const mjData_& data, const CameraView& camera,
                 mjvScene_* scene);

}  // namespace shoal::worlds
