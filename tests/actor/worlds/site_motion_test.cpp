// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/site_motion.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>

#include "actor/worlds/fetch_object_world.h"

namespace shoal::worlds {
namespace {

std::array<double, 9> Turn(size_t axis, double angle) {
  std::array<double, 9> matrix{1, 0, 0, 0, 1, 0, 0, 0, 1};
  const size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
  matrix[3 * a + a] = matrix[3 * b + b] = std::cos(angle);
  matrix[3 * a + b] = -std::sin(angle);
  matrix[3 * b + a] = std::sin(angle);
  return matrix;
}

TEST(EulerAngles, ATurnAboutOneAxisIsThatComponent) {
  for (size_t axis = 0; axis < 3; ++axis) {
    for (const double angle : {-1.2, -0.3, 0.0, 0.7, 1.5}) {
      std::array<double, 3> expected{};
      expected[axis] = angle;
      const std::array<double, 3> angles = EulerAngles(Turn(axis, angle).data());
      for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(angles[i], expected[i], 1e-12) << axis << i;
    }
  }
}

TEST(EulerAngles, AtAPitchOfNinetyDegreesTheTurnIsCountedAsOneAboutZ) {
  // Rz(0.4) Ry(90 degrees), whose first two elements of the last column and row vanish.
  const std::array<double, 9> matrix{0, -std::sin(0.4), 1, 0, std::cos(0.4), 0, -1, 0, 0};
  const std::array<double, 3> angles = EulerAngles(matrix.data());
  EXPECT_EQ(angles[0], 0);
  EXPECT_NEAR(angles[1], M_PI / 2, 1e-12);
}

TEST(SiteVelocity, IsThatOfTheBodyThatCarriesTheSite) {
  const std::unique_ptr<World> world = MakeFetchPush({});
  auto& push = dynamic_cast<FetchObjectWorld&>(*world);
  push.ResetTo({1.3, 0.7, 0.45}, {1.4, 0.8});
  const int dof = push.model().jnt_dofadr[push.JointId("object0:joint")];
  const std::array<double, 6> velocity{0.1, -0.2, 0.3, 1, 2, 3};
  for (size_t i = 0; i < 6; ++i) push.data().qvel[dof + static_cast<int>(i)] = velocity[i];
  const SiteVelocity moved = VelocityOfSite(push, push.object_site());
  for (size_t i = 0; i < 3; ++i) {
    // The block stands unturned, so its own frame is the world's.
    EXPECT_NEAR(moved.linear[i], velocity[i], 1e-9);
    EXPECT_NEAR(moved.angular[i], velocity[3 + i], 1e-6);
  }
}

}  // namespace
}  // namespace shoal::worlds
