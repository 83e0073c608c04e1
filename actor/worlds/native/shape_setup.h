// SPDX-License-Identifier: Apache-2.0
// Conversion of a geom of the engine's abstract scene to a shape for the kernels.
#pragma once

#include <array>

#include "actor/worlds/native/camera_frame.h"
#include "actor/worlds/native/frame_job.h"

struct mjvGeom_;

namespace shoal::worlds::native {

// Ids that a shape may use: its first, plus one for each face.
constexpr int kIdsPerShape = 6;

// A geom in camera coordinates.
struct PlacedGeom {
  Vector3 centre;
  std::array<Vector3, 3> axes;
  std::array<double, 3> size;
};

PlacedGeom Place(const mjvGeom_& geom, const CameraFrame& frame);

// Fills `shape` for a plane, sphere, capsule, ellipsoid, cylinder or box. The shape's rect covers
// at least its visible part. False if no part of the geom is in view. CHECK on other types.
bool MakeShape(const mjvGeom_& geom, const PlacedGeom& placed, const CameraFrame& frame,
               const View& view, int id, Shape* shape);

}  // namespace shoal::worlds::native
