// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/drawing_order.h"

#include <mujoco/mujoco.h>

#include <algorithm>

#include "actor/worlds/native/geom_rules.h"
#include "common/base/error.h"

namespace shoal::worlds::native {
namespace {

constexpr double kBehindAll = 1e10;  // distance of transparent planes: behind everything

double DistanceOf(const mjvGeom& geom, const CameraFrame& frame) {
  if (geom.type == mjGEOM_PLANE) return kBehindAll;
  return Length(FromFloats(geom.pos) - frame.position) - BoundingRadius(geom);
}

}  // namespace

void DrawingOrder::Sort(const mjvScene& scene, const CameraFrame& frame) {
  fixed.clear();
  moving.clear();
  transparent.clear();
  distances_.resize(static_cast<size_t>(scene.ngeom));
  for (int i = 0; i < scene.ngeom; ++i) {
    const mjvGeom& geom = scene.geoms[i];
    CheckGeom(geom, i);
    if (geom.rgba[3] <= 0 || !HasExtent(geom)) continue;
    if (!Drawable(geom.type)) {
      throw RuntimeError("quality native does not draw geom {} of the scene: its type is {}", i,
                         geom.type);
    }
    if (IsTransparent(geom, frame)) {
      distances_[static_cast<size_t>(i)] = DistanceOf(geom, frame);
      transparent.push_back(i);
    } else if (geom.category == mjCAT_STATIC && geom.objtype == mjOBJ_GEOM) {
      fixed.push_back(i);
    } else {
      moving.push_back(i);
    }
  }
  std::ranges::stable_sort(transparent, {},
                           [this](int i) { return distances_[static_cast<size_t>(i)]; });
}

}  // namespace shoal::worlds::native
