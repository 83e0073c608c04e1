// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/scene_culling.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace shoal::worlds {
namespace {

struct Vector {
  float x, y, z;
};

Vector From(const float* v) { return {v[0], v[1], v[2]}; }
Vector Sum(float a, Vector u, float b, Vector v) {
  return {a * u.x + b * v.x, a * u.y + b * v.y, a * u.z + b * v.z};
}
float Dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vector Cross(Vector a, Vector b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Extent of the geom from its centre along a unit vector; no value = unknown.
std::optional<float> Reach(const mjvGeom& geom, Vector along) {
  const auto axis = [&geom](int i) {
    return Vector{geom.mat[i], geom.mat[3 + i], geom.mat[6 + i]};
  };
  const float x = Dot(along, axis(0)), y = Dot(along, axis(1)), z = Dot(along, axis(2));
  const float* size = geom.size;
  switch (geom.type) {
    case mjGEOM_SPHERE:
      return size[0];
    case mjGEOM_ELLIPSOID:
      return std::sqrt(size[0] * size[0] * x * x + size[1] * size[1] * y * y +
                       size[2] * size[2] * z * z);
    case mjGEOM_BOX:
      return size[0] * std::fabs(x) + size[1] * std::fabs(y) + size[2] * std::fabs(z);
    case mjGEOM_CYLINDER:
      return size[0] * std::sqrt(x * x + y * y) + size[2] * std::fabs(z);
    case mjGEOM_CAPSULE:
      return size[0] + size[2] * std::fabs(z);
    case mjGEOM_PLANE:
      return std::nullopt;
    default:
      if (geom.modelrbound > 0) return geom.modelrbound;
      return std::nullopt;
  }
}

// The planes that bound the view, without the far one. Normals point out of the view.
class Frustum {
 public:
  Frustum(const mjvScene& scene, float aspect) {
    // The engine draws from the mean of the scene's two (stereo) cameras.
    const mjvGLCamera& left = scene.camera[0];
    const Vector position = Sum(0.5f, From(left.pos), 0.5f, From(scene.camera[1].pos));
    const Vector forward = From(left.forward), up = From(left.up), right = Cross(forward, up);
    const float tangent_y = left.frustum_top / left.frustum_near;
    const float tangent_x = tangent_y * aspect;
    const float cos_x = 1 / std::sqrt(1 + tangent_x * tangent_x), sin_x = tangent_x * cos_x;
    const float cos_y = 1 / std::sqrt(1 + tangent_y * tangent_y), sin_y = tangent_y * cos_y;
    planes_ = {{{Sum(cos_x, right, -sin_x, forward), 0},
                {Sum(-cos_x, right, -sin_x, forward), 0},
                {Sum(cos_y, up, -sin_y, forward), 0},
                {Sum(-cos_y, up, -sin_y, forward), 0},
                {Sum(-1, forward, 0, forward), -left.frustum_near}}};
    for (Plane& plane : planes_) plane.offset += Dot(plane.normal, position);
  }

  bool MaySee(const mjvGeom& geom) const {
    for (const Plane& plane : planes_) {
      const std::optional<float> reach = Reach(geom, plane.normal);
      if (!reach) return true;
      if (Dot(plane.normal, From(geom.pos)) - plane.offset > *reach) return false;
    }
    return true;
  }

 private:
  struct Plane {
    Vector normal;
    float offset;  // of the plane's points along the normal
  };
  std::array<Plane, 5> planes_;
};

// Whether the box contains the geom. A contained geom is hidden from every camera.
bool Holds(const mjvGeom& box, const mjvGeom& geom) {
  const Vector offset = Sum(1, From(geom.pos), -1, From(box.pos));
  for (int i = 0; i < 3; ++i) {
    const Vector axis{box.mat[i], box.mat[3 + i], box.mat[6 + i]};
    const std::optional<float> reach = Reach(geom, axis);
    if (!reach || std::fabs(Dot(offset, axis)) + *reach >= box.size[i]) return false;
  }
  return true;
}

bool IsInsideABox(const mjvScene& scene, const mjvGeom& geom) {
  return std::any_of(scene.geoms, scene.geoms + scene.ngeom, [&geom](const mjvGeom& other) {
    return other.type == mjGEOM_BOX && other.rgba[3] >= 1 && Holds(other, geom);
  });
}

}  // namespace

void RemoveUnseenGeoms(mjvScene* scene, float aspect) {
  const Frustum frustum(*scene, aspect);
  int kept = 0;
  for (int i = 0; i < scene->ngeom; ++i) {
    const mjvGeom& geom = scene->geoms[i];
    if (geom.rgba[3] <= 0 || !frustum.MaySee(geom)) continue;
    // Sites also mark places inside bodies, such as the block's centre.
    if (geom.objtype == mjOBJ_SITE && IsInsideABox(*scene, geom)) continue;
    if (kept != i) scene->geoms[kept] = geom;
    ++kept;
  }
  scene->ngeom = kept;
}

}  // namespace shoal::worlds
