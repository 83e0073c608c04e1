// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/surface_setup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "actor/worlds/native/shape_setup.h"
#include "tests/actor/worlds/native/scene_by_hand.h"

namespace shoal::worlds::native {
namespace {

class SurfaceSetup : public testing::Test {
 protected:
  SurfaceSetup() {
    frame_ = FrameOf(hand_.scene(), 40, 40);
    tables_.Fill(frame_, 40, 40, &view_);
  }

  // The surfaces of the scene's last geom.
  std::vector<Surface> Make(bool transparent = false) {
    const mjvGeom& geom = hand_.geoms().back();
    const PlacedGeom placed = Place(geom, frame_);
    Shape shape;
    EXPECT_TRUE(MakeShape(geom, placed, frame_, view_, 6, &shape));
    lights_.emplace_back(hand_.scene(), frame_);
    colours_.clear();
    lights_.back().AddColours(geom, &colours_);
    std::vector<Surface> surfaces;
    AddSurfaces(geom, placed, shape, {&lights_.back(), textures_, &grids_, nullptr, 3},
                colours_.data(), transparent, &surfaces);
    return surfaces;
  }

  SceneByHand hand_;
  CameraFrame frame_;
  RayTables tables_;
  View view_{};
  mjModel model_ = EmptyModel();
  PlaneGrids grids_{model_};
  std::vector<const Texture*> textures_;
  std::vector<SceneLights> lights_;
  std::vector<LightColour> colours_;
};

TEST_F(SurfaceSetup, LightsThatCastShadowsComeLast) {
  hand_.scene().nlight = 3;
  for (int i = 1; i < 3; ++i) {
    mjvLight& light = hand_.scene().lights[i];
    light = {};
    light.dir[2] = -2;
    light.directional = 1;
    light.castshadow = i == 1;
    light.diffuse[0] = static_cast<float>(i);
  }
  const SceneLights lights(hand_.scene(), frame_);
  ASSERT_EQ(lights.lights().size(), 3u);
  EXPECT_FALSE(lights.lights()[1].own_pass);
  EXPECT_TRUE(lights.lights()[2].own_pass);
  // Towards the light: up, which is the camera's y; the direction has length 1.
  EXPECT_FLOAT_EQ(lights.lights()[1].direction[1], 1);
  // The headlight comes from the eye.
  EXPECT_FLOAT_EQ(lights.lights()[0].direction[2], -1);
  std::vector<LightColour> colours;
  lights.AddColours(hand_.Add(mjGEOM_BOX, {4, 0, 0}, {1, 1, 1}), &colours);
  ASSERT_EQ(colours.size(), 3u);
  EXPECT_FLOAT_EQ(colours[1].diffuse[0], 2);
  EXPECT_FLOAT_EQ(colours[2].diffuse[0], 1);
}

TEST_F(SurfaceSetup, WithoutLightsThereIsALittleOfIt) {
  hand_.scene().nlight = 0;
  EXPECT_FLOAT_EQ(SceneLights(hand_.scene(), frame_).global_ambient(), 0.3f);
  hand_.Add(mjGEOM_BOX, {4, 0, 0}, {1, 1, 1}).rgba[1] = 0.5f;
  const std::vector<Surface> surfaces = Make();
  EXPECT_FLOAT_EQ(surfaces.at(0).light[0], 0.3f);
  EXPECT_FLOAT_EQ(surfaces.at(0).light[1], 0.15f);
}

TEST_F(SurfaceSetup, DullFacesUnderDirectionalLightHaveOneColour) {
  mjvGeom& box = hand_.Add(mjGEOM_BOX, {4, 0, 0}, {1, 1, 1});
  box.rgba[2] = 0.5f;
  box.emission = 0.05f;
  const std::vector<Surface> surfaces = Make();
  ASSERT_EQ(surfaces.size(), 1u) << "one face is towards the eye";
  EXPECT_TRUE(surfaces[0].one_light);
  EXPECT_EQ(surfaces[0].id, 6) << "face 0";
  EXPECT_NEAR(surfaces[0].light[0], 0.2 + 0.7 + 0.05, 1e-6);
  EXPECT_NEAR(surfaces[0].light[2], 0.475, 1e-6);
  box.specular = 0.5f;
  EXPECT_FALSE(Make()[0].one_light) << "it shines";
  box.specular = 0;
  hand_.scene().nlight = 2;
  hand_.scene().lights[1] = {};
  hand_.scene().lights[1].cutoff = 45;
  EXPECT_FALSE(Make()[0].one_light) << "a spot shines on it";
}

TEST_F(SurfaceSetup, ShinyPlanesUnderDirectionalLightHaveOneDullLight) {
  mjvGeom& plane = hand_.Add(mjGEOM_PLANE, {4, 0, 0}, {1, 1, 1});
  const float upright[9] = {0, 0, -1, 0, 1, 0, 1, 0, 0};
  std::copy(upright, upright + 9, plane.mat);
  EXPECT_FALSE(Make()[0].one_dull_light) << "it has one light";
  plane.specular = 0.5f;
  plane.shininess = 0.5f;
  EXPECT_TRUE(Make()[0].one_dull_light);
  plane.shininess = 0.03f;
  EXPECT_FALSE(Make()[0].one_dull_light) << "it shines everywhere";
  plane.shininess = 0.5f;
  hand_.scene().nlight = 2;
  hand_.scene().lights[1] = {};
  hand_.scene().lights[1].cutoff = 45;
  EXPECT_FALSE(Make()[0].one_dull_light) << "a spot shines on it";
  hand_.scene().nlight = 1;
  mjvGeom& ball = hand_.Add(mjGEOM_SPHERE, {4, 0, 0}, {1, 1, 1});
  ball.specular = ball.shininess = 0.5f;
  EXPECT_FALSE(Make()[0].one_dull_light) << "it is no plane";
}

// The light of each pass is limited by itself, but what is transparent has one pass.
TEST_F(SurfaceSetup, LightIsLimitedPassByPass) {
  hand_.scene().nlight = 2;
  hand_.scene().lights[1] = hand_.scene().lights[0];
  hand_.scene().lights[1].castshadow = 1;
  hand_.Add(mjGEOM_BOX, {4, 0, 0}, {1, 1, 1});
  EXPECT_NEAR(Make()[0].light[0], 1.8, 1e-6);
  EXPECT_NEAR(Make(/*transparent=*/true)[0].light[0], 1, 1e-6);
}

// least_shine leaves out less than a quarter of a grey level.
TEST_F(SurfaceSetup, InvisibleShineIsLeftOut) {
  mjvGeom& ball = hand_.Add(mjGEOM_SPHERE, {4, 0, 0}, {1, 1, 1});
  ball.specular = 1;
  for (const float shininess : {0.0f, 0.03f, 0.2f, 0.5f, 1.0f}) {
    ball.shininess = shininess;
    const Surface surface = Make()[0];
    EXPECT_FLOAT_EQ(surface.exponent, 64 * shininess) << "of the cosine's square";
    EXPECT_LT(surface.least_shine, 1);
    if (surface.least_shine == 0) continue;
    EXPECT_LT(std::pow(surface.least_shine, surface.exponent), 0.25 / 255) << shininess;
    EXPECT_GE(shininess, 0.2f) << "a broad shine is seen everywhere";
  }
  ball.shininess = 0.5f;
  EXPECT_EQ(Make()[0].whole_exponent, 32);
  ball.shininess = 0.03f;
  EXPECT_EQ(Make()[0].whole_exponent, -1);
}

TEST_F(SurfaceSetup, EachShapeHasItsNormals) {
  const auto kind = [this](int type, std::array<float, 3> size) {
    hand_.Add(type, {4, 0, 0}, size);
    return Make().back().normal_kind;
  };
  EXPECT_EQ(kind(mjGEOM_SPHERE, {1, 1, 1}), kRound);
  EXPECT_EQ(kind(mjGEOM_ELLIPSOID, {1, 1, 1}), kRound);
  EXPECT_EQ(kind(mjGEOM_ELLIPSOID, {1, 0.5f, 1}), kOval);
  EXPECT_EQ(kind(mjGEOM_CAPSULE, {0.5f, 0.5f, 1}), kRod);
  EXPECT_EQ(kind(mjGEOM_CYLINDER, {0.5f, 0.5f, 1}), kRod);
  EXPECT_EQ(kind(mjGEOM_BOX, {1, 1, 1}), kFlat);
}

}  // namespace
}  // namespace shoal::worlds::native
