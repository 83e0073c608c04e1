#include "actor/worlds/scene_culling.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

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
    geom.objid = static_cast<int>(geoms_.size()) - 1;
    geom.pos[0] = x;
    geom.pos[1] = y;
    geom.pos[2] = z;
    geom.size[0] = geom.size[1] = geom.size[2] = geom.modelrbound = radius;
    geom.rgba[3] = 1;
    return geom;
  }

  // Ids of what is left.
  std::vector<int> Seen() {
    std::vector<mjvGeom> geoms = geoms_;
    scene_.geoms = geoms.data();
    scene_.ngeom = static_cast<int>(geoms.size());
    RemoveUnseenGeoms(&scene_, kAspect);
    std::vector<int> ids;
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
  // Spheres beside a corner of the view are kept although nothing of them is seen; few others are.
  EXPECT_LT(seen.size(), size_t(in_view) + 50);
}

TEST(SceneCulling, LeavesOutWhatIsBehindBesideOrInvisible) {
  SphereScene scene;
  scene.Add(-3, 0, 0, 1);
  scene.Add(4, 5, 0, 1);
  scene.Add(4, 0, -4, 1);
  scene.Add(4, 0, 0, 1).rgba[3] = 0;
  scene.Add(4, 0, 0, 1);
  EXPECT_EQ(scene.Seen(), std::vector<int>{4});
}

TEST(SceneCulling, KeepsPlanesAndWhatHasNoBound) {
  SphereScene scene;
  scene.Add(-3, 0, 0, 1).type = mjGEOM_PLANE;
  scene.Add(-3, 0, 0, 1).modelrbound = 0;
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
