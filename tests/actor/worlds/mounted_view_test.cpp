// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/mounted_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include "actor/worlds/custom_cameras.h"
#include "actor/worlds/render_context.h"
#include "actor/worlds/world_registry.h"
#include "common/base/error.h"

namespace shoal::worlds {
namespace {

using testing::HasSubstr;

std::vector<uint8_t> Picture(World* world, const CameraView& camera, const std::string& quality) {
  ObservationConfig observation;
  observation.height = observation.width = 64;
  observation.quality = quality;
  RenderContext context(observation);
  context.Attach(world);
  std::vector<uint8_t> frame(3 * 64 * 64);
  context.Render(world, std::span(&camera, 1), frame);
  return frame;
}

// The gripper's x axis points down, its z axis along the world's x.
TEST(MountedView, NumbersAreInTheBodysFrame) {
  const auto world = MakeWorld("FetchPush", {});
  Random random(1);
  world->Reset(&random);
  const int body = world->BodyId("robot0:gripper_link");
  for (int step = 0; step < 3; ++step) {
    mjvScene scene;
    mjv_defaultScene(&scene);
    MountCamera(world->model(), world->data(),
                {"hand", {0.1, 0.2, 0.3}, 0.5, 0, 0, "robot0:gripper_link"}, &scene);
    const double* at = world->data().xpos + 3 * body;
    for (const mjvGLCamera& eye : scene.camera) {
      EXPECT_NEAR(eye.pos[0], at[0] + 0.3, 0.01) << "z of the gripper";
      EXPECT_NEAR(eye.pos[1], at[1] + 0.2, 0.01);
      EXPECT_NEAR(eye.pos[2], at[2] + 0.4, 0.01) << "0.5 above 0.1 below";
      EXPECT_NEAR(eye.forward[2], -1, 0.01);
      EXPECT_NEAR(eye.up[0], 1, 0.01);
    }
    world->Step(std::vector<double>{1, 1, 1, 0});  // the body moves, and the view with it
  }
}

TEST(MountedView, OnTheWorldItIsTheFreeView) {
  const auto world = MakeWorld("FetchPush", {});
  Random random(1);
  world->Reset(&random);
  CameraView front = FindCamera(*world, "front");
  for (const char* quality : {"fast", "reference"}) {
    front.body = "";
    const auto free = Picture(world.get(), front, quality);
    front.body = "world";
    EXPECT_EQ(Picture(world.get(), front, quality), free) << quality;
  }
}

TEST(MountedView, ABodyThatTheModelDoesNotHaveIsNamed) {
  ObservationConfig observation;
  observation.custom_cameras["hand"] = {{0, 0, 0}, 1, 0, 0, "palm"};
  try {
    ChooseCamera(*MakeWorld("FetchReach", {}), observation, "hand");
    ADD_FAILURE() << "a view from nowhere";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("'hand'"), HasSubstr("'palm'")));
  }
}

}  // namespace
}  // namespace shoal::worlds
