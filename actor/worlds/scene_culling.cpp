#include "actor/worlds/scene_culling.h"

#include <mujoco/mujoco.h>

#include <cmath>

namespace shoal::worlds {
namespace {

struct Vector {
  float x, y, z;
};

Vector From(const float* v) { return {v[0], v[1], v[2]}; }
float Dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vector Cross(Vector a, Vector b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// The five planes of the view without the far one, through the camera's position. A side plane's
// inward normal leans from the axis `right` or `up` by the half angle.
class Frustum {
 public:
  Frustum(const mjvScene& scene, float aspect) {
    // The engine draws the mean of the scene's two (stereo) cameras.
    const mjvGLCamera& left = scene.camera[0];
    const mjvGLCamera& right = scene.camera[1];
    position_ = {(left.pos[0] + right.pos[0]) / 2, (left.pos[1] + right.pos[1]) / 2,
                 (left.pos[2] + right.pos[2]) / 2};
    forward_ = From(left.forward);
    up_ = From(left.up);
    right_ = Cross(forward_, up_);
    near_ = left.frustum_near;
    const float tangent_y = left.frustum_top / left.frustum_near;
    const float tangent_x = tangent_y * aspect;
    cos_x_ = 1 / std::sqrt(1 + tangent_x * tangent_x);
    sin_x_ = tangent_x * cos_x_;
    cos_y_ = 1 / std::sqrt(1 + tangent_y * tangent_y);
    sin_y_ = tangent_y * cos_y_;
  }

  bool MaySee(const float* center, float radius) const {
    const Vector p = From(center);
    const Vector offset{p.x - position_.x, p.y - position_.y, p.z - position_.z};
    const float depth = Dot(offset, forward_);
    const float x = std::fabs(Dot(offset, right_));
    const float y = std::fabs(Dot(offset, up_));
    return depth > near_ - radius && x * cos_x_ - depth * sin_x_ < radius &&
           y * cos_y_ - depth * sin_y_ < radius;
  }

 private:
  Vector position_, forward_, up_, right_;
  float near_, cos_x_, sin_x_, cos_y_, sin_y_;
};

// Radius of a sphere around the geom's centre that holds it, 0 = unknown.
float BoundingRadius(const mjvGeom& geom) {
  if (geom.type == mjGEOM_PLANE) return 0;
  if (geom.modelrbound > 0) return geom.modelrbound;
  // Sites carry no bound; the sum of the sizes bounds every shape a site can have.
  if (geom.objtype == mjOBJ_SITE) return geom.size[0] + geom.size[1] + geom.size[2];
  return 0;
}

}  // namespace

void RemoveUnseenGeoms(mjvScene* scene, float aspect) {
  const Frustum frustum(*scene, aspect);
  int kept = 0;
  for (int i = 0; i < scene->ngeom; ++i) {
    const mjvGeom& geom = scene->geoms[i];
    const float radius = BoundingRadius(geom);
    const bool seen = geom.rgba[3] > 0 && (radius <= 0 || frustum.MaySee(geom.pos, radius));
    if (!seen) continue;
    if (kept != i) scene->geoms[kept] = geom;
    ++kept;
  }
  scene->ngeom = kept;
}

}  // namespace shoal::worlds
