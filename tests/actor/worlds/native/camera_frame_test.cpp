// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/camera_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/base/error.h"
#include "tests/actor/worlds/native/scene_by_hand.h"

namespace shoal::worlds::native {
namespace {

TEST(CameraFrame, AxesAreThoseOfTheGaze) {
  SceneByHand hand;
  const CameraFrame frame = FrameOf(hand.scene(), 200, 100);
  // The gaze is along +x, up is +z: right is -y.
  const Vector3 point = frame.Direction({3, -2, 1});
  EXPECT_DOUBLE_EQ(point.x, 2);
  EXPECT_DOUBLE_EQ(point.y, 1);
  EXPECT_DOUBLE_EQ(point.z, 3);
  EXPECT_NEAR(frame.half_height, 0.5, 1e-6);
  EXPECT_NEAR(frame.half_width, 1, 1e-6) << "twice as wide as high";
  EXPECT_NEAR(frame.centre_y, 0, 1e-6);
}

// The engine has two eyes; pictures are drawn from between them.
TEST(CameraFrame, TheEyeIsBetweenTheSceneEyes) {
  SceneByHand hand;
  hand.scene().camera[0].pos[1] = 0.2f;
  hand.scene().camera[1].pos[1] = -0.4f;
  hand.scene().camera[1].frustum_near = 0.3f;
  const CameraFrame frame = FrameOf(hand.scene(), 8, 8);
  EXPECT_NEAR(frame.position.y, -0.1, 1e-6);
  EXPECT_NEAR(frame.near, 0.2, 1e-6);
  EXPECT_NEAR(frame.Point({5, -0.1, 0}).z, 5, 1e-6);
  EXPECT_NEAR(frame.Point({5, -0.1, 0}).x, 0, 1e-6);
}

TEST(CameraFrame, FrustumsMayBeOffCentre) {
  SceneByHand hand;
  for (mjvGLCamera& camera : hand.scene().camera) camera.frustum_top = 0.15f;
  const CameraFrame frame = FrameOf(hand.scene(), 8, 8);
  EXPECT_NEAR(frame.half_height, 1, 1e-6);
  EXPECT_NEAR(frame.centre_y, 0.5, 1e-6);
}

TEST(CameraFrame, WhatIsNoCameraIsRefused) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto refused = [](void (*spoil)(mjvGLCamera*, float), float value) {
    SceneByHand hand;
    for (mjvGLCamera& camera : hand.scene().camera) spoil(&camera, value);
    EXPECT_THROW(FrameOf(hand.scene(), 8, 8), Error);
  };
  refused([](mjvGLCamera* camera, float value) { camera->pos[1] = value; }, nan);
  refused([](mjvGLCamera* camera, float value) { camera->forward[0] = value; }, nan);
  refused([](mjvGLCamera* camera, float value) { camera->frustum_near = value; }, 0);
  refused([](mjvGLCamera* camera, float value) { camera->frustum_top = value; }, -0.05f);
  refused([](mjvGLCamera* camera, float value) { camera->up[2] = value; }, 0);
  refused([](mjvGLCamera* camera, float value) { camera->frustum_far = value; }, nan);
}

// Column and row of lane i of a tile, as frame_job.h orders them.
int ColumnOf(size_t i) { return static_cast<int>((i & 1) + 2 * (i >> 2 & 1)); }
int RowOf(size_t i) { return static_cast<int>((i >> 1 & 1) + 2 * (i >> 3)); }

TEST(RayTables, RaysGoThroughTheMiddlesOfPixels) {
  SceneByHand hand;
  RayTables tables;
  for (const auto& [width, height] : {std::array{8, 4}, std::array{6, 9}, std::array{8, 4}}) {
    const CameraFrame frame = FrameOf(hand.scene(), width, height);
    View view{};
    tables.Fill(frame, width, height, &view);
    EXPECT_EQ(view.tiles_x, (width + 3) / 4);
    EXPECT_EQ(view.tiles_y, (height + 3) / 4);
    EXPECT_FLOAT_EQ(view.pixel, 1.0f / static_cast<float>(height));
    EXPECT_FLOAT_EQ(view.w_near, 10);
    EXPECT_FLOAT_EQ(view.w_far, 0.01f);
    for (int tile_y = 0; tile_y < view.tiles_y; ++tile_y) {
      for (int tile_x = 0; tile_x < view.tiles_x; ++tile_x) {
        for (size_t i = 0; i < 16; ++i) {
          const double x =
              (4 * tile_x + ColumnOf(i) + 0.5 - 0.5 * width) / height;  // square pixels
          const double y = 0.5 - (4 * tile_y + RowOf(i) + 0.5) / height;
          ASSERT_NEAR(view.ray_x[tile_x * 16 + static_cast<int>(i)], x, 1e-6);
          ASSERT_NEAR(view.ray_y[tile_y * 16 + static_cast<int>(i)], y, 1e-6);
          const int tile = tile_y * view.tiles_x + tile_x;
          ASSERT_NEAR(view.inverse_length[tile * 16 + static_cast<int>(i)],
                      1 / std::sqrt(x * x + y * y + 1), 1e-6);
        }
      }
    }
  }
}

}  // namespace
}  // namespace shoal::worlds::native
