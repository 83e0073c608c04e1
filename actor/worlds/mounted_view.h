// SPDX-License-Identifier: Apache-2.0
// Views that move with a body of the model.
#pragma once

#include "actor/worlds/camera_view.h"

struct mjData_;
struct mjModel_;
struct mjvScene_;

namespace shoal::worlds {

// Throws Error (kUsage) naming camera and body when the model has no body of that name. Views that
// are not mounted are left alone.
void CheckMount(const mjModel_& model, const CameraView& camera);

// Moves the scene's camera, and its headlight, to where the mounted `camera` is now. The scene has
// been updated with a free camera, of which the field of view stays. CHECK: CheckMount passes.
void MountCamera(const mjModel_& model, const mjData_& data, const CameraView& camera,
                 mjvScene_* scene);

}  // namespace shoal::worlds
