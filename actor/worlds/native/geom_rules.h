// SPDX-License-Identifier: Apache-2.0
// The engine's rules for geoms: which geoms are drawn, which are transparent, in which order. Also
// finds models and scenes with content that cannot be drawn.
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

// True if the engine shows geoms of this group by default.
bool GroupIsShown(int group);

bool Drawable(int type);

// Throws Error (kNonFinite) naming the geom's number in the scene if the geom is not finite.
void CheckGeom(const mjvGeom_& geom, int number);

// False if the geom has no extent; such a geom is not visible.
bool HasExtent(const mjvGeom_& geom);

// True if the eye is behind the geom's plane z = 0.
bool IsBehind(const mjvGeom_& geom, const CameraFrame& frame);
bool IsTransparent(const mjvGeom_& geom, const CameraFrame& frame);

// Radius that the engine subtracts from a geom's distance when it sorts transparent geoms.
double BoundingRadius(const mjvGeom_& geom);

}  // namespace shoal::worlds::native
