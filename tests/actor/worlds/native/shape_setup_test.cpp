// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/shape_setup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/actor/worlds/native/scene_by_hand.h"

namespace shoal::worlds::native {
namespace {

constexpr int kViewSide = 40;

// Looks along +x from the origin.
class ShapeSetup : public testing::Test {
 protected:
  ShapeSetup() {
    frame_ = FrameOf(hand_.scene(), kViewSide, kViewSide);
    tables_.Fill(frame_, kViewSide, kViewSide, &view_);
  }
  bool Make(const mjvGeom& geom) {
    return MakeShape(geom, Place(geom, frame_), frame_, view_, 6, &shape_);
  }
  // The affine function on the ray through the picture's (right, up).
  double At(const Affine& f, double right, double up) const {
    return f.c + f.x * (right - shape_.x) + f.y * (up - shape_.y);
  }
  // The larger root of the quadric there, NaN where the ray misses it.
  double Root(const Quadric& q, double right, double up) const {
    const double x = right - shape_.x, y = up - shape_.y;
    const double d = q.d + x * (q.dx + q.dxx * x + q.dxy * y) + y * (q.dy + q.dyy * y);
    return At(q.b, right, up) + std::sqrt(d);
  }

  SceneByHand hand_;
  CameraFrame frame_;
  RayTables tables_;
  View view_{};
  Shape shape_{};
};

TEST_F(ShapeSetup, GeomsArePlacedBeforeTheCamera) {
  mjvGeom& geom = hand_.Add(mjGEOM_BOX, {4, 1, 2}, {1, 2, 3});
  const PlacedGeom placed = Place(geom, frame_);
  EXPECT_DOUBLE_EQ(placed.centre.x, -1) << "+y is on the left";
  EXPECT_DOUBLE_EQ(placed.centre.y, 2);
  EXPECT_DOUBLE_EQ(placed.centre.z, 4);
  EXPECT_DOUBLE_EQ(placed.axes[0].z, 1);
  EXPECT_DOUBLE_EQ(placed.axes[1].x, -1);
  EXPECT_DOUBLE_EQ(placed.axes[2].y, 1);
  EXPECT_DOUBLE_EQ(placed.size[2], 3);
}

TEST_F(ShapeSetup, ASphereIsItsFrontAndItsRim) {
  ASSERT_TRUE(Make(hand_.Add(mjGEOM_SPHERE, {4, 0, 0}, {1, 1, 1})));
  EXPECT_EQ(shape_.kind, kEllipsoid);
  EXPECT_EQ(shape_.id, 6);
  EXPECT_NEAR(Root(shape_.quadric, 0, 0), 1 / 3.0, 1e-6) << "depth 3";
  const double rim = 1 / std::sqrt(15.0);  // tangent of the cone's half angle
  EXPECT_FALSE(std::isnan(Root(shape_.quadric, rim - 1e-4, 0)));
  EXPECT_TRUE(std::isnan(Root(shape_.quadric, rim + 1e-4, 0)));
  EXPECT_TRUE(std::isnan(Root(shape_.quadric, 0, -rim - 1e-4)));
  // The rectangle has all tiles of the rim and not many more: 0.258 of 40 pixels about the middle.
  EXPECT_EQ(shape_.rect.left, 2);
  EXPECT_EQ(shape_.rect.right, 8);
}

TEST_F(ShapeSetup, ACapsuleHasASideAndTwoCaps) {
  ASSERT_TRUE(Make(hand_.Add(mjGEOM_CAPSULE, {4, 0, 0}, {0.5f, 0.5f, 1})));
  EXPECT_EQ(shape_.kind, kCapsule);
  EXPECT_FALSE(shape_.inside_side);
  EXPECT_NEAR(Root(shape_.quadric, 0, 0), 1 / 3.5, 1e-6);
  // The upper cap is about (4, 0, 1): along the ray to its middle its front is half a metre nearer.
  const double reach = std::sqrt(17.0);
  EXPECT_NEAR(Root(shape_.caps[0], 0, 0.25), reach / (4 * (reach - 0.5)), 1e-6);
  EXPECT_NEAR(Root(shape_.caps[1], 0, -0.25), reach / (4 * (reach - 0.5)), 1e-6);
  EXPECT_FLOAT_EQ(shape_.z_low, -1);
  EXPECT_FLOAT_EQ(shape_.z_high, 1);
}

TEST_F(ShapeSetup, ACylinderSeenFromAboveEntersByItsUpperFace) {
  ASSERT_TRUE(Make(hand_.Add(mjGEOM_CYLINDER, {4, 0, -1}, {1, 1, 0.5f})));
  ASSERT_EQ(shape_.enters, 1);
  EXPECT_EQ(shape_.faces[0], 1);
  // The face is half a metre below the eye: seen at depth 0.5 / slope.
  EXPECT_NEAR(At(shape_.enter[0], 0, -0.125), 0.25, 1e-6);
  EXPECT_EQ(shape_.leaves, 1);
}

TEST_F(ShapeSetup, ABoxShowsTheFacesTowardsTheEye) {
  ASSERT_TRUE(Make(hand_.Add(mjGEOM_BOX, {4, 0, 0}, {1, 1, 1})));
  ASSERT_EQ(shape_.enters, 1);
  EXPECT_EQ(shape_.faces[0], 0) << "at -x";
  EXPECT_EQ(shape_.leaves, 5);
  EXPECT_NEAR(At(shape_.enter[0], 0.1, 0.2), 1 / 3.0, 1e-6);
  ASSERT_TRUE(Make(hand_.Add(mjGEOM_BOX, {4, 1.5f, -1.5f}, {1, 1, 1})));
  EXPECT_EQ(shape_.enters, 3);
  std::sort(shape_.faces, shape_.faces + 3);
  EXPECT_EQ(shape_.faces[0], 0);
  EXPECT_EQ(shape_.faces[1], 2) << "at -y, towards the eye's side";
  EXPECT_EQ(shape_.faces[2], 5) << "at +z";
}

TEST_F(ShapeSetup, APlaneIsBoundedOnlyWhereItHasASize) {
  ASSERT_TRUE(Make(hand_.Add(mjGEOM_PLANE, {4, 0, -1}, {2, 3, 1})));
  EXPECT_EQ(shape_.insides, 4);
  EXPECT_NEAR(At(shape_.enter[0], 0, -0.25), 0.25, 1e-6);
  // Its near edge is at depth 2, its far one at 6.
  const auto inside = [this](double up) {
    return std::all_of(shape_.inside, shape_.inside + 4,
                       [&](const Affine& f) { return At(f, 0, up) >= 0; });
  };
  EXPECT_TRUE(inside(-0.49));
  EXPECT_FALSE(inside(-0.51));
  EXPECT_TRUE(inside(-0.17));
  EXPECT_FALSE(inside(-0.16));
  ASSERT_TRUE(Make(hand_.Add(mjGEOM_PLANE, {4, 0, -1}, {0, 0, 1})));
  EXPECT_EQ(shape_.insides, 0);
  EXPECT_FALSE(Make(hand_.Add(mjGEOM_PLANE, {4, 0, 0}, {0, 0, 1}))) << "edge on";
}

TEST_F(ShapeSetup, WhatIsOutOfViewIsLeftOut) {
  for (const int type :
       {mjGEOM_SPHERE, mjGEOM_CAPSULE, mjGEOM_ELLIPSOID, mjGEOM_CYLINDER, mjGEOM_BOX}) {
    EXPECT_FALSE(Make(hand_.Add(type, {-4, 0, 0}, {1, 1, 1}))) << "behind, " << type;
    EXPECT_FALSE(Make(hand_.Add(type, {4, 9, 0}, {1, 1, 1}))) << "on the left, " << type;
    EXPECT_FALSE(Make(hand_.Add(type, {0, 0, 0}, {3, 3, 3}))) << "around the eye, " << type;
    EXPECT_TRUE(Make(hand_.Add(type, {4, 2, 0}, {1, 1, 1}))) << "at the edge, " << type;
  }
}

}  // namespace
}  // namespace shoal::worlds::native
