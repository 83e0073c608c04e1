// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <limits>

#include "actor/worlds/model_loading.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/actor/worlds/engine_warnings.h"
#include "tests/support/temporary_folder.h"

namespace shoal::worlds {
namespace {

// A ball that falls: the least that is a world.
class FallingBall final : public World {
 public:
  FallingBall() : World(Load()) {}

  void Reset(Random*) override { mj_resetData(&model(), &data()); }
  Outcome Step(std::span<const double>) override {
    Advance(1);
    return {};
  }
  void Observe(std::span<double>, std::span<double>, std::span<double>) const override {}
  std::span<const CameraView> cameras() const override { return {}; }

 private:
  static ModelHandle Load() {
    const TemporaryFolder folder;
    const auto path = folder.path() / "ball.xml";
    WriteFileAtomically(path, R"(<mujoco><worldbody><body name="ball">
        <joint name="free" type="free"/><geom size="0.1"/><site name="centre"/>
        </body></worldbody></mujoco>)");
    return LoadModel("", path.string());
  }
};

TEST(World, StepsTheEngine) {
  FallingBall world;
  const double before = world.data().qpos[2];
  for (int i = 0; i < 10; ++i) world.Step({});
  EXPECT_LT(world.data().qpos[2], before);
  EXPECT_NEAR(world.data().time, 10 * world.model().opt.timestep, 1e-12);
}

TEST(World, AStateThatIsNotFiniteIsAnErrorAndNotASilentReset) {
  ExpectEngineWarnings(1);
  FallingBall world;
  world.Step({});
  world.data().qvel[0] = std::numeric_limits<double>::quiet_NaN();
  try {
    world.Step({});
    FAIL() << "went on";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), static_cast<int>(ErrorKind::kNonFinite));
    EXPECT_THAT(error.what(), testing::HasSubstr("the simulation diverged"));
  }
}

TEST(World, FindsElementsByNameAndNamesTheOnesItLacks) {
  const FallingBall world;
  EXPECT_EQ(world.BodyId("ball"), 1);
  EXPECT_EQ(world.SiteId("centre"), 0);
  EXPECT_EQ(world.JointId("free"), 0);
  try {
    world.SiteId("robot0:grip");
    FAIL() << "found a site that is not there";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("no site named 'robot0:grip'"));
  }
}

}  // namespace
}  // namespace shoal::worlds
