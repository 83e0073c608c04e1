// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/geom_rules.h"

#include <fmt/core.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>

#include "common/base/error.h"

namespace shoal::worlds::native {
namespace {

constexpr float kOpaque = 0.995f;  // alpha below which the engine blends

std::string NameOf(const mjModel& model, int object_type, int id) {
  const char* name = mj_id2name(&model, object_type, id);
  return name == nullptr ? "" : name;
}

}  // namespace

std::string RefusalOf(const mjModel& model) {
  if (model.nskin > 0) return fmt::format("it has {} skins", model.nskin);
  for (int i = 0; i < model.nsensor; ++i) {
    if (model.sensor_type[i] != mjSENS_RANGEFINDER) continue;
    return fmt::format("sensor {} ('{}') is a rangefinder, which the engine shows as a line", i,
                       NameOf(model, mjOBJ_SENSOR, i));
  }
  return "";
}

void CheckFlags(const mjvScene& scene) {
  if (scene.flags[mjRND_FOG]) {
    throw RuntimeError(
        "quality native does not draw the fog that the scene's flags ask for; "
        "expected mjRND_FOG = 0, or quality fast or reference");
  }
}

bool GroupIsShown(int group) {
  mjvOption option;
  mjv_defaultOption(&option);
  return option.geomgroup[std::clamp(group, 0, mjNGROUP - 1)] != 0;
}

bool Drawable(int type) {
  return type == mjGEOM_PLANE || type == mjGEOM_SPHERE || type == mjGEOM_CAPSULE ||
         type == mjGEOM_ELLIPSOID || type == mjGEOM_CYLINDER || type == mjGEOM_BOX ||
         type == mjGEOM_MESH || type == mjGEOM_HFIELD;
}

void CheckGeom(const mjvGeom& geom, int number) {
  float sum = 0;
  for (const float v : geom.pos) sum += v;
  for (const float v : geom.mat) sum += v;
  for (const float v : geom.size) sum += v;
  for (const float v : geom.rgba) sum += v;
  if (!std::isfinite(sum)) {
    throw NonFiniteError("geom {} of the scene (object {}) is not finite: position ({}, {}, {})",
                         number, geom.objid, geom.pos[0], geom.pos[1], geom.pos[2]);
  }
}

bool HasExtent(const mjvGeom& geom) {
  const float* s = geom.size;
  switch (geom.type) {
    case mjGEOM_SPHERE:
    case mjGEOM_ELLIPSOID:
      return s[0] > 0 && s[1] > 0 && s[2] > 0;
    case mjGEOM_CAPSULE:
    case mjGEOM_CYLINDER:
      return s[0] > 0 && s[2] >= 0;
    case mjGEOM_BOX:
      return s[0] >= 0 && s[1] >= 0 && s[2] >= 0;
    default:
      return true;
  }
}

bool IsBehind(const mjvGeom& geom, const CameraFrame& frame) {
  return Dot(frame.position - FromFloats(geom.pos), ColumnOf(geom.mat, 2)) < 0;
}

bool IsTransparent(const mjvGeom& geom, const CameraFrame& frame) {
  return geom.rgba[3] < kOpaque || (geom.type == mjGEOM_PLANE && IsBehind(geom, frame));
}

double BoundingRadius(const mjvGeom& geom) {
  const double x = geom.size[0], y = geom.size[1], z = geom.size[2];
  if (geom.objtype == mjOBJ_GEOM) return geom.modelrbound;
  switch (geom.type) {
    case mjGEOM_SPHERE:
      return x;
    case mjGEOM_CAPSULE:
      return x + z;
    case mjGEOM_CYLINDER:
      return std::sqrt(x * x + z * z);
    case mjGEOM_BOX:
      return std::sqrt(x * x + y * y + z * z);
    default:
      return std::max({x, y, z});
  }
}

}  // namespace shoal::worlds::native
