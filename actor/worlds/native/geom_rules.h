// SPDX-License-Identifier: Apache-2.0
// How the engine treats geoms of a scene: which are drawn, which are transparent, in which order.
#pragma once

#include "actor/worlds/native/camera_frame.h"

struct mjvGeom_;

namespace shoal::worlds::native {

bool Drawable(int type);

// Throws Error (kNonFinite) with the geom's number in the scene when it is not finite.
void CheckGeom(const mjvGeom_& geom, int number);

// Bodies without extent show nothing.
bool HasExtent(const mjvGeom_& geom);

// The eye is behind the geom's z = 0.
bool IsBehind(const mjvGeom_& geom, const CameraFrame& frame);
bool IsTransparent(const mjvGeom_& geom, const CameraFrame& frame);

// The engine sorts transparent geoms by their distance less this.
double BoundingRadius(const mjvGeom_& geom);

}  // namespace shoal::worlds::native
