// SPDX-License-Identifier: Apache-2.0
// Bounds on the tiles of a picture that a body in camera coordinates can touch.
#pragma once

#include <array>
#include <span>

#include "actor/worlds/native/camera_frame.h"
#include "actor/worlds/native/frame_job.h"

namespace shoal::worlds::native {

// Range of ray coordinates X and Y. Empty when right < left or top < bottom.
struct RayRect {
  double left, right, bottom, top;
};

RayRect EmptyRect();
RayRect Union(const RayRect& a, const RayRect& b);

// An ellipsoid about `centre` with half axes `radii` along `axes`; a radius may
// be 0 (a disc).
RayRect BoundEllipsoid(Vector3 centre, const std::array<Vector3, 3>& axes,
                       const std::array<double, 3>& radii, double near);

// The convex hull of points, by edges (pairs of points) that are cut at the
// near plane.
RayRect BoundHull(std::span<const Vector3> points, std::span<const std::array<int, 2>> edges,
                  double near);

// Finds the tiles of the view with pixels in the rectangle or up to a hundredth of a pixel outside.
// False if there are none.
bool TilesOf(const RayRect& rect, const CameraFrame& frame, const View& view, TileRect* tiles);

}  // namespace shoal::worlds::native
