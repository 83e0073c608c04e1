// SPDX-License-Identifier: Apache-2.0
// How the engine treats geoms: which are drawn, which are transparent, in which order; and which
// models and scenes ask for more than can be drawn.
#pragma once

#include <string>

#include "actor/worlds/native/camera_frame.h"

struct mjModel_;
struct mjvGeom_;
struct mjvScene_;

namespace shoal::worlds::native {

// Why the content of this model cannot be drawn; empty = it can.
std::string RefusalOf(const mjModel_& model);

// Throws Error (kRuntime) on a scene whose flags ask for fog. The flags of shadows, reflections and
// the sky are not read.
void CheckFlags(const mjvScene_& scene);

// Whether the engine shows geoms of this group by default.
bool GroupIsShown(int group);

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
