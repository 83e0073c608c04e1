// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/world_registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "actor/worlds/custom_cameras.h"
#include "common/base/error.h"
#include "common/tasks/task_registry.h"

namespace shoal::worlds {
namespace {

using testing::HasSubstr;

TEST(WorldRegistry, EveryTaskHasAPhysicsHalf) {
  for (const std::string& name : tasks::TaskNames()) {
    EXPECT_NE(MakeWorld(tasks::FindTask(name).world(), {}), nullptr) << name;
  }
}

TEST(WorldRegistry, OnlyFetchHasThePhysicsOfMujoco3) {
  for (const std::string& name : tasks::TaskNames()) {
    const std::string& world = tasks::FindTask(name).world();
    const WorldOptions options{.model = "", .physics = "mujoco3"};
    if (world.starts_with("Fetch")) {
      EXPECT_NE(MakeWorld(world, options), nullptr) << name;
    } else {
      EXPECT_THROW(MakeWorld(world, options), Error) << name;
    }
  }
}

TEST(WorldRegistry, FindsCamerasByNameAndListsThemOtherwise) {
  const auto world = MakeWorld("FetchReach", {});
  for (const char* name : {"gymnasium", "close", "front", "side"}) {
    EXPECT_EQ(FindCamera(*world, name).name, name);
  }
  try {
    FindCamera(*world, "behind");
    FAIL() << "found a camera that is not there";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    EXPECT_THAT(error.what(), HasSubstr("'behind'"));
    EXPECT_THAT(error.what(), HasSubstr("front, side, close, gymnasium"));
  }
}

TEST(WorldRegistry, AGoalHalfWithoutPhysicsIsAUsageError) {
  try {
    MakeWorld("Juggling", {});
    FAIL() << "found a world that is not there";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    EXPECT_THAT(error.what(), HasSubstr("no physics half 'Juggling'"));
  }
}

}  // namespace
}  // namespace shoal::worlds
