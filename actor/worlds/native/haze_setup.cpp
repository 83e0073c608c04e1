// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/haze_setup.h"

#include <mujoco/mujoco.h>

namespace shoal::worlds::native {
namespace {

constexpr double kSkyRadius = 0.7;  // share of the far plane's distance, as in the engine

bool IsEndless(const mjvGeom& geom) {
  return geom.type == mjGEOM_PLANE && geom.size[0] == 0 && geom.size[1] == 0;
}

}  // namespace

HazeStyle::HazeStyle(const mjModel& model) : width(model.vis.map.haze) {
  for (int c = 0; c < 3; ++c) rgb[c] = 255 * model.vis.rgba.haze[c];
}

bool MakeHaze(const mjvScene& scene, const CameraFrame& frame, const HazeStyle& style, Haze* haze) {
  int plane = 0;
  while (plane < scene.ngeom && !IsEndless(scene.geoms[plane])) ++plane;
  if (plane == scene.ngeom) return false;
  const mjvGeom& geom = scene.geoms[plane];
  const double radius = kSkyRadius * frame.far;
  const double elevation =
      Dot(frame.position - FromFloats(geom.pos), ColumnOf(geom.mat, 2)) / radius;
  *haze = {};
  haze->inverse_sky = static_cast<float>(1 / radius);
  haze->seen = style.width > 0 && scene.flags[mjRND_HAZE] && elevation >= 0;
  for (int k = 0; k < 3; ++k) {
    const Vector3 axis = frame.Direction(ColumnOf(geom.mat, k));
    haze->axes[k][0] = static_cast<float>(axis.x);
    haze->axes[k][1] = static_cast<float>(axis.y);
    haze->axes[k][2] = static_cast<float>(axis.z);
  }
  haze->elevation = static_cast<float>(elevation);
  haze->width = style.width;
  haze->peak = static_cast<float>(1 / (1 + double{style.width}));
  for (int c = 0; c < 3; ++c) haze->rgb[c] = style.rgb[c];
  return true;
}

}  // namespace shoal::worlds::native
