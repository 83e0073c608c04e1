// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/geom_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/actor/worlds/native/scene_by_hand.h"

namespace shoal::worlds::native {
namespace {

using testing::HasSubstr;

// An endless plane under a sky.
class HazeTest : public testing::Test {
 protected:
  HazeTest() {
    model_.ngeom = model_.ntex = 1;
    model_.geom_type = &type_;
    model_.geom_size = size_;
    model_.geom_group = &group_;
    model_.tex_type = &texture_;
    model_.vis.map.haze = 0.3f;
    model_.names = &no_name_;
    model_.name_geomadr = &address_;
  }

  mjModel model_ = EmptyModel();
  int type_ = mjGEOM_PLANE, group_ = 0, texture_ = mjTEXTURE_SKYBOX, address_ = 0;
  mjtNum size_[3] = {0, 0, 1};
  char no_name_ = '\0';
};

TEST_F(HazeTest, IsRefusedByTheNumberOfThePlane) {
  EXPECT_THAT(RefusalOf(model_), HasSubstr("geom 0"));
  EXPECT_THAT(RefusalOf(model_), HasSubstr("haze"));
}

TEST_F(HazeTest, IsNotDrawnAroundPlanesWithASize) {
  size_[1] = 3;
  EXPECT_EQ(RefusalOf(model_), "");
}

TEST_F(HazeTest, IsNotDrawnByGeomsThatAreNotShown) {
  group_ = 4;
  EXPECT_EQ(RefusalOf(model_), "");
}

TEST_F(HazeTest, IsNotDrawnWithoutASky) {
  texture_ = mjTEXTURE_CUBE;
  EXPECT_EQ(RefusalOf(model_), "");
}

TEST_F(HazeTest, MayBeTurnedOff) {
  model_.vis.map.haze = 0;
  EXPECT_EQ(RefusalOf(model_), "");
}

TEST(GeomRules, ScenesWithFogAreRefused) {
  SceneByHand hand;
  CheckFlags(hand.scene());
  hand.scene().flags[mjRND_FOG] = 1;
  try {
    CheckFlags(hand.scene());
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("fog"));
    EXPECT_THAT(error.what(), HasSubstr("reference"));
  }
}

}  // namespace
}  // namespace shoal::worlds::native
