// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/screen_bounds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/random.h"

namespace shoal::worlds::native {
namespace {

constexpr std::array<Vector3, 3> kAxes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

TEST(ScreenBounds, ASpheresTangentsAreAtItsAngle) {
  const RayRect rect = BoundEllipsoid({0, 0, 2}, kAxes, {1, 1, 1}, 0.1);
  // The half angle's sine is 1/2.
  EXPECT_NEAR(rect.right, std::sqrt(1.0 / 3), 1e-12);
  EXPECT_NEAR(rect.left, -std::sqrt(1.0 / 3), 1e-12);
  EXPECT_NEAR(rect.top, std::sqrt(1.0 / 3), 1e-12);
}

// Points on random ellipsoids are within their rectangles, and some are close to each side.
TEST(ScreenBounds, AnEllipsoidTouchesItsRectangle) {
  Random random(2);
  const Vector3 z = Normalized({0.3, -0.5, 0.8}), x = Normalized(Cross({0, 1, 0}, z));
  const std::array<Vector3, 3> axes{x, Cross(z, x), z};
  const std::array<double, 3> radii{0.3, 0.7, 0.1};
  const Vector3 centre{0.5, -0.4, 3};
  const RayRect rect = BoundEllipsoid(centre, axes, radii, 0.1);
  RayRect seen = EmptyRect();
  for (int i = 0; i < 20'000; ++i) {
    const Vector3 on =
        Normalized({random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1)});
    const Vector3 p =
        centre + radii[0] * on.x * axes[0] + radii[1] * on.y * axes[1] + radii[2] * on.z * axes[2];
    seen = Union(seen, {p.x / p.z, p.x / p.z, p.y / p.z, p.y / p.z});
  }
  EXPECT_LE(rect.left, seen.left);
  EXPECT_GE(rect.right, seen.right);
  EXPECT_LE(rect.bottom, seen.bottom);
  EXPECT_GE(rect.top, seen.top);
  EXPECT_NEAR(rect.left, seen.left, 2e-3);
  EXPECT_NEAR(rect.right, seen.right, 2e-3);
  EXPECT_NEAR(rect.bottom, seen.bottom, 2e-3);
  EXPECT_NEAR(rect.top, seen.top, 2e-3);
}

TEST(ScreenBounds, WhatReachesBehindTheEyeIsEverywhere) {
  const RayRect rect = BoundEllipsoid({0, 0, 0.5}, kAxes, {1, 1, 1}, 0.1);
  EXPECT_EQ(rect.left, -HUGE_VAL);
  EXPECT_EQ(rect.top, HUGE_VAL);
  const RayRect behind = BoundEllipsoid({0, 0, -2}, kAxes, {1, 1, 1}, 0.1);
  EXPECT_GT(behind.left, behind.right);
}

TEST(ScreenBounds, EdgesAreCutAtTheNearPlane) {
  const std::array<Vector3, 2> line{{{0, 0, -1}, {1, 0, 1}}};
  const std::array<int, 2> edge{0, 1};
  const RayRect rect = BoundHull(line, {&edge, 1}, 0.5);
  EXPECT_NEAR(rect.left, 1, 1e-12);     // at depth 1
  EXPECT_NEAR(rect.right, 1.5, 1e-12);  // at depth 0.5: x = 0.75
}

TEST(ScreenBounds, TilesHoldThePixelsWithCentresInside) {
  CameraFrame frame;
  frame.half_width = frame.half_height = 0.5;
  View view{};
  view.width = view.height = 16;
  view.tiles_x = view.tiles_y = 4;
  TileRect tiles;
  // Pixel centres are at -0.5 + (i + 0.5) / 16. From the centre of column 4 to that of column 7.
  ASSERT_TRUE(TilesOf({-0.5 + 4.5 / 16, -0.5 + 7.5 / 16, 0, 0.4}, frame, view, &tiles));
  EXPECT_EQ(tiles.left, 1);
  EXPECT_EQ(tiles.right, 2);
  EXPECT_EQ(tiles.top, 0);
  EXPECT_EQ(tiles.bottom, 2);
  // Between two centres.
  EXPECT_FALSE(TilesOf({-0.5 + 4.6 / 16, -0.5 + 5.4 / 16, 0, 0.4}, frame, view, &tiles));
  EXPECT_FALSE(TilesOf({0.6, 0.7, 0, 0.4}, frame, view, &tiles));
  EXPECT_FALSE(TilesOf(EmptyRect(), frame, view, &tiles));
}

}  // namespace
}  // namespace shoal::worlds::native
