// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/tools/robot_in_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include "actor/worlds/world_registry.h"
#include "common/base/error.h"

namespace shoal::worlds {
namespace {

ObservationConfig Small() {
  ObservationConfig observation;
  observation.width = 60;
  observation.height = 40;
  return observation;
}

TEST(RobotInPicture, TheArmCoversAPartOfEachCloseView) {
  const auto world = MakeWorld("FetchReach", {});
  for (const char* camera : {"front", "side", "close"}) {
    const double share = RobotShare(world.get(), "robot0:", camera, Small());
    EXPECT_GT(share, 0.05) << camera;
    EXPECT_LT(share, 0.6) << camera;
  }
}

TEST(RobotInPicture, AnEmptyPictureHasNone) {
  const auto world = MakeWorld("FetchReach", {});
  for (int geom = 0; geom < world->model().ngeom; ++geom)
    world->model().geom_rgba[4 * geom + 3] = 0;
  EXPECT_EQ(RobotShare(world.get(), "robot0:", "front", Small()), 0);
  const Picture blank{2, 1, std::vector<uint8_t>(6, 7)};
  EXPECT_EQ(ChangedShare(blank, blank), 0);
}

TEST(RobotInPicture, CountsPixelsAndNotNumbers) {
  Picture a{2, 1, {1, 2, 3, 4, 5, 6}}, b = a;
  b.pixels[0] = 9;
  b.pixels[1] = 9;
  EXPECT_DOUBLE_EQ(ChangedShare(a, b), 0.5);
}

TEST(RobotInPicture, LeavesTheWorldAsItWas) {
  const auto world = MakeWorld("FetchReach", {});
  const std::vector<float> before(world->model().geom_rgba,
                                  world->model().geom_rgba + 4 * world->model().ngeom);
  RobotShare(world.get(), "robot0:", "front", Small());
  const std::vector<float> after(world->model().geom_rgba,
                                 world->model().geom_rgba + 4 * world->model().ngeom);
  EXPECT_EQ(before, after);
}

TEST(RobotInPicture, AnAbsentBodyOrCameraIsRefusedByName) {
  const auto world = MakeWorld("FetchReach", {});
  const auto complaint = [&](const std::string& prefix, const std::string& camera) -> std::string {
    try {
      RobotShare(world.get(), prefix, camera, Small());
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(complaint("dog:", "front"), testing::HasSubstr("dog:"));
  EXPECT_THAT(complaint("robot0:", "inside"), testing::HasSubstr("inside"));
}

}  // namespace
}  // namespace shoal::worlds
