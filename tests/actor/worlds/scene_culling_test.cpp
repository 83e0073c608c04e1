// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/scene_culling.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "common/base/random.h"

namespace shoal::worlds {
namespace {

constexpr float kAspect = 1.5f;

// A scene of unit spheres without a model behind it.
class SphereScene {
 public:
  SphereScene() {
    std::memset(&scene_, 0, sizeof(scene_));
    mjvGLCamera& camera = scene_.camera[0];
    const float position[] = {0, 0, 0}, forward[] = {1, 0, 0}, up[] = {0, 0, 1};
    std::memcpy(camera.pos, position, sizeof(position));
    std::memcpy(camera.forward, forward, sizeof(forward));
    std::memcpy(camera.up, up, sizeof(up));
    camera.frustum_near = 0.1f;
    camera.frustum_far = 100;
    camera.frustum_top = 0.05f;
    camera.frustum_bottom = -0.05f;
    scene_.camera[1] = camera;
  }

  mjvGeom& Add(float x, float y, float z, float radius) {
    mjvGeom& geom = geoms_.emplace_back();
    std::memset(&geom, 0, sizeof(geom));
    geom.type = mjGEOM_SPHERE;
    geom.objtype = mjOBJ_GEOM;
    geom.objid = int(geoms_.size()) - 1;
    geom.pos[0] = x;
    geom.pos[1] = y;
    geom.pos[2] = z;
    geom.size[0] = geom.size[1] = geom.size[2] = geom.modelrbound = radius;
    geom.mat[0] = geom.mat[4] = geom.mat[8] = 1;
    geom.rgba[3] = 1;
    return geom;
  }

  // Ids of the remaining geoms.
  std::vector<int> Seen() {
    std::vector<mjvGeom> geoms = geoms_;
    scene_.geoms = geoms.data();
    scene_.ngeom = int(geoms.size());
    RemoveUnseenGeoms(&scene_, kAspect);
    std::vector<int> ids;
    ids.reserve(scene_.ngeom);
    for (int i = 0; i < scene_.ngeom; ++i) ids.push_back(scene_.geoms[i].objid);
    return ids;
  }

  const std::vector<mjvGeom>& geoms() const { return geoms_; }

 private:
  mjvScene scene_;
  std::vector<mjvGeom> geoms_;
};

// Whether the point falls into the picture: half a unit of height and 0.75 of width per unit depth.
bool InView(float x, float y, float z) {
  return x > 0.1f && std::fabs(z) < 0.5f * x && std::fabs(y) < 0.5f * kAspect * x;
}

// Whether any of many points on and in the sphere falls into the picture.
bool AnyPointInView(const mjvGeom& geom, Random* random) {
  for (int i = 0; i < 400; ++i) {
    const double angle = random->Uniform(0, 2 * M_PI), height = random->Uniform(-1, 1);
    const double ring = std::sqrt(1 - height * height);
    const double reach = geom.modelrbound * std::cbrt(random->Uniform());
    if (InView(geom.pos[0] + float(reach * ring * std::cos(angle)),
               geom.pos[1] + float(reach * ring * std::sin(angle)),
               geom.pos[2] + float(reach * height))) {
      return true;
    }
  }
  return false;
}

TEST(SceneCulling, KeepsEveryGeomOfWhichAPointIsInView) {
  SphereScene scene;
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    scene.Add(float(random.Uniform(-5, 10)), float(random.Uniform(-8, 8)),
              float(random.Uniform(-6, 6)), float(random.Uniform(0.05, 2)));
  }
  const std::vector<int> seen = scene.Seen();
  std::vector<bool> kept(scene.geoms().size());
  for (const int id : seen) kept[size_t(id)] = true;
  int in_view = 0;
  for (size_t i = 0; i < kept.size(); ++i) {
    if (!AnyPointInView(scene.geoms()[i], &random)) continue;
    ++in_view;
    EXPECT_TRUE(kept[i]) << i;
  }
  EXPECT_GT(in_view, 100);
  // Spheres near a corner of the view are kept although they are invisible; few others are kept.
  EXPECT_LT(seen.size(), size_t(in_view) + 50);
}

// A rotated geom that is both long and thin; points of the shape itself.
struct Shape {
  int type;
  bool (*holds)(double x, double y,
                double z);  // of sizes 0.1, 0.2, 1.5 (round ones: 0.1, 0.1, 1.5)
};

class CulledShape : public testing::TestWithParam<Shape> {};

TEST_P(CulledShape, IsKeptWhereAPointIsInViewAndHardlyElsewhere) {
  const Shape& shape = GetParam();
  SphereScene scene;
  Random random(4);
  for (int i = 0; i < 400; ++i) {
    mjvGeom& geom = scene.Add(float(random.Uniform(-3, 6)), float(random.Uniform(-5, 5)),
                              float(random.Uniform(-4, 4)), 1.8f);
    geom.type = shape.type;
    geom.size[0] = 0.1f;
    geom.size[1] = shape.type == mjGEOM_BOX || shape.type == mjGEOM_ELLIPSOID ? 0.2f : 0.1f;
    geom.size[2] = 1.5f;
    const double axis[] = {random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1)};
    double quaternion[4] = {random.Uniform(-1, 1), axis[0], axis[1], axis[2]}, matrix[9];
    mju_normalize4(quaternion);
    mju_quat2Mat(matrix, quaternion);
    mju_n2f(geom.mat, matrix, 9);
  }
  std::vector<bool> kept(scene.geoms().size());
  for (const int id : scene.Seen()) kept[size_t(id)] = true;
  int in_view = 0, kept_in_vain = 0;
  for (size_t i = 0; i < kept.size(); ++i) {
    const mjvGeom& geom = scene.geoms()[i];
    bool seen = false;
    for (int draw = 0; draw < 3000 && !seen; ++draw) {
      const double x = random.Uniform(-0.2, 0.2), y = random.Uniform(-0.2, 0.2);
      const double z = random.Uniform(-1.6, 1.6);
      if (!shape.holds(x, y, z)) continue;
      float point[3];
      for (int k = 0; k < 3; ++k) {
        point[k] = geom.pos[k] + geom.mat[3 * k] * float(x) + geom.mat[3 * k + 1] * float(y) +
                   geom.mat[3 * k + 2] * float(z);
      }
      seen = InView(point[0], point[1], point[2]);
    }
    in_view += seen;
    kept_in_vain += kept[i] && !seen;
    EXPECT_TRUE(kept[i] || !seen) << i;
  }
  EXPECT_GT(in_view, 60);
  EXPECT_LT(kept_in_vain, in_view / 5);
}

bool InBox(double x, double y, double z) {
  return std::fabs(x) <= 0.1 && std::fabs(y) <= 0.2 && std::fabs(z) <= 1.5;
}
bool InCylinder(double x, double y, double z) {
  return std::hypot(x, y) <= 0.1 && std::fabs(z) <= 1.5;
}
bool InCapsule(double x, double y, double z) {
  return std::hypot(x, y, std::max(0.0, std::fabs(z) - 1.5)) <= 0.1;
}
bool InEllipsoid(double x, double y, double z) {
  return std::hypot(x / 0.1, y / 0.2, z / 1.5) <= 1;
}

INSTANTIATE_TEST_SUITE_P(SceneCulling, CulledShape,
                         testing::Values(Shape{mjGEOM_BOX, InBox},
                                         Shape{mjGEOM_CYLINDER, InCylinder},
                                         Shape{mjGEOM_CAPSULE, InCapsule},
                                         Shape{mjGEOM_ELLIPSOID, InEllipsoid}));

TEST(SceneCulling, LeavesOutWhatIsBehindBesideOrInvisible) {
  SphereScene scene;
  scene.Add(-3, 0, 0, 1);
  scene.Add(4, 5, 0, 1);
  scene.Add(4, 0, -4, 1);
  scene.Add(4, 0, 0, 1).rgba[3] = 0;
  scene.Add(4, 0, 0, 1);
  EXPECT_EQ(scene.Seen(), std::vector<int>{4});
}

TEST(SceneCulling, LeavesOutSitesWithinOpaqueBoxesAlone) {
  for (const bool opaque : {true, false}) {
    SphereScene scene;
    mjvGeom& box = scene.Add(4, 0, 0, 1.8f);
    box.type = mjGEOM_BOX;
    box.size[0] = box.size[1] = box.size[2] = 1;
    if (!opaque) box.rgba[3] = 0.9f;
    scene.Add(4, 0, 0, 0.9f).objtype = mjOBJ_SITE;
    scene.Add(4, 0, 0.3f, 0.8f).objtype = mjOBJ_SITE;  // through the top
    scene.Add(4, 0, 0, 0.5f);                          // no site
    EXPECT_EQ(scene.Seen(), opaque ? (std::vector<int>{0, 2, 3}) : (std::vector<int>{0, 1, 2, 3}));
  }
}

TEST(SceneCulling, KeepsPlanesAndWhatHasNoBound) {
  SphereScene scene;
  scene.Add(-3, 0, 0, 1).type = mjGEOM_PLANE;
  mjvGeom& unbounded = scene.Add(-3, 0, 0, 1);
  unbounded.type = mjGEOM_MESH;
  unbounded.modelrbound = 0;
  EXPECT_EQ(scene.Seen(), (std::vector<int>{0, 1}));
}

TEST(SceneCulling, BoundsSitesByTheirSizes) {
  SphereScene scene;
  for (const float x : {-3.0f, 3.0f}) {
    mjvGeom& site = scene.Add(x, 0, 0, 0.5f);
    site.objtype = mjOBJ_SITE;
    site.modelrbound = 0;
  }
  EXPECT_EQ(scene.Seen(), std::vector<int>{1});
}

}  // namespace
}  // namespace shoal::worlds
