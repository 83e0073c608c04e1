// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/drawing_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/actor/worlds/native/scene_by_hand.h"

namespace shoal::worlds::native {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class DrawingOrderTest : public testing::Test {
 protected:
  void Sort() { order_.Sort(hand_.scene(), FrameOf(hand_.scene(), 64, 64)); }

  SceneByHand hand_;
  DrawingOrder order_;
};

TEST_F(DrawingOrderTest, OnlyGeomsOfStaticBodiesAreFixed) {
  hand_.Add(mjGEOM_SPHERE, {3, 0, 0}, {1, 1, 1});
  hand_.Add(mjGEOM_SPHERE, {3, 0, 0}, {1, 1, 1}).category = mjCAT_STATIC;
  mjvGeom& site = hand_.Add(mjGEOM_SPHERE, {3, 0, 0}, {1, 1, 1});
  site.category = mjCAT_STATIC;
  site.objtype = mjOBJ_SITE;
  Sort();
  EXPECT_THAT(order_.fixed, ElementsAre(1));
  EXPECT_THAT(order_.moving, ElementsAre(0, 2));
}

// By the distance of the nearest point of the bounding sphere; planes come last.
TEST_F(DrawingOrderTest, TransparentGeomsAreSortedFromTheNearest) {
  hand_.Add(mjGEOM_PLANE, {1, 0, 0}, {1, 1, 1});
  hand_.Add(mjGEOM_SPHERE, {3, 0, 0}, {0.1f, 0.1f, 0.1f}).modelrbound = 0.1f;
  hand_.Add(mjGEOM_SPHERE, {4, 0, 0}, {2, 2, 2}).modelrbound = 2;
  hand_.Add(mjGEOM_SPHERE, {0, 3, 0}, {0.1f, 0.1f, 0.1f}).modelrbound = 0.1f;
  for (mjvGeom& geom : hand_.geoms()) geom.rgba[3] = 0.5f;
  Sort();
  EXPECT_THAT(order_.transparent, ElementsAre(2, 1, 3, 0));
  EXPECT_THAT(order_.moving, IsEmpty());
}

TEST_F(DrawingOrderTest, InvisibleGeomsAreLeftOutAndNothingStaysOfTheLastScene) {
  hand_.Add(mjGEOM_SPHERE, {3, 0, 0}, {1, 1, 1});
  Sort();
  hand_.geoms()[0].rgba[3] = 0;
  hand_.Add(mjGEOM_SPHERE, {3, 0, 0}, {0, 0, 0});
  Sort();
  EXPECT_THAT(order_.moving, IsEmpty());
  EXPECT_THAT(order_.transparent, IsEmpty());
}

}  // namespace
}  // namespace shoal::worlds::native
