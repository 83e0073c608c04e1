// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/abstract_scene.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>

#include "actor/worlds/custom_cameras.h"
#include "actor/worlds/fetch_reach.h"
#include "common/base/random.h"

namespace shoal::worlds {
namespace {

class AbstractSceneTest : public testing::Test {
 protected:
  AbstractSceneTest() {
    Random random(3);
    world_->Reset(&random);
    scene_.Allocate(*world_);
  }
  mjvScene& See(const CameraView& camera) {
    scene_.Update(world_.get(), camera);
    return scene_.scene();
  }

  std::unique_ptr<World> world_ = MakeFetchReach({});
  AbstractScene scene_;
};

TEST_F(AbstractSceneTest, HasTheShownGeomsAndSitesOfTheModel) {
  const mjvScene& scene = See(FindCamera(*world_, "front"));
  int geoms = 0, sites = 0;
  for (int i = 0; i < scene.ngeom; ++i) {
    geoms += scene.geoms[i].objtype == mjOBJ_GEOM;
    sites += scene.geoms[i].objtype == mjOBJ_SITE;
  }
  EXPECT_GT(geoms, 20);
  EXPECT_GE(sites, 1) << "the goal's marker";
  EXPECT_EQ(geoms + sites, scene.ngeom);
  EXPECT_GE(scene.nlight, 1);
}

TEST_F(AbstractSceneTest, AFreeCameraLooksAtItsPoint) {
  const CameraView front = FindCamera(*world_, "front");
  ASSERT_LT(front.model_camera, 0);
  const mjvScene& scene = See(front);
  for (size_t k = 0; k < 3; ++k) {
    const double eye = 0.5 * (double{scene.camera[0].pos[k]} + scene.camera[1].pos[k]);
    EXPECT_NEAR(eye + front.distance * double{scene.camera[0].forward[k]}, front.lookat[k], 1e-5);
  }
}

// The camera is not a part of the state: all cameras see the same geoms.
TEST_F(AbstractSceneTest, TwoCamerasSeeOneState) {
  const auto poses = [this](const char* camera) {
    const mjvScene& scene = See(FindCamera(*world_, camera));
    std::vector<float> all;
    for (int i = 0; i < scene.ngeom; ++i) {
      all.insert(all.end(), scene.geoms[i].pos, scene.geoms[i].pos + 3);
      all.insert(all.end(), scene.geoms[i].mat, scene.geoms[i].mat + 9);
    }
    all.push_back(scene.camera[0].pos[0]);
    return all;
  };
  std::vector<float> front = poses("front"), side = poses("side");
  EXPECT_NE(front.back(), side.back()) << "the same camera";
  front.pop_back();
  side.pop_back();
  EXPECT_EQ(front, side);
}

TEST_F(AbstractSceneTest, FollowsTheWorld) {
  const CameraView camera = FindCamera(*world_, "front");
  const auto site_at = [](const mjvScene& scene) {
    float sum = 0;
    for (int i = 0; i < scene.ngeom; ++i) sum += scene.geoms[i].pos[0];
    return sum;
  };
  const float before = site_at(See(camera));
  for (int i = 0; i < 5; ++i) world_->Step(std::vector<double>{1, 1, 1, 0});
  EXPECT_GT(std::fabs(site_at(See(camera)) - before), 1e-3f);
}

TEST_F(AbstractSceneTest, MountedCamerasMoveWithTheirBody) {
  const CameraView wrist = FindCamera(*world_, "wrist");
  ASSERT_FALSE(wrist.body.empty());
  const float before = See(wrist).camera[0].pos[0];
  for (int i = 0; i < 5; ++i) world_->Step(std::vector<double>{1, 0, 0, 0});
  EXPECT_GT(See(wrist).camera[0].pos[0], before + 0.01f);
}

TEST(AbstractSceneDeathTest, ASceneWithoutRoomIsABug) {
  const auto world = MakeFetchReach({});
  AbstractScene scene;
  EXPECT_DEATH(scene.Update(world.get(), FindCamera(*world, "front")), "a scene without room");
}

}  // namespace
}  // namespace shoal::worlds
