// SPDX-License-Identifier: Apache-2.0
// Whether the pixels-only preset can be solved at all: its two cameras show every goal.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <memory>
#include <vector>

#include "actor/worlds/custom_cameras.h"
#include "actor/worlds/fetch_reach.h"
#include "actor/worlds/render_context.h"
#include "actor/worlds/world_registry.h"

namespace shoal::worlds {
namespace {

// Grey levels, summed over pixels and channels, that three pixels turning from white to red make.
constexpr int kThreePixels = 3 * 2 * 255;
constexpr std::array<double, 3> kOutOfSight{1.34, 0.75, -0.5};

class GoalMarkerTest : public testing::Test {
 protected:
  std::vector<uint8_t> Draw(const std::array<double, 3>& goal) {
    world_.ResetTo(goal);
    std::vector<uint8_t> frame(2 * 3 * 84 * 84);
    render_->Render(&world_, cameras_, frame);
    return frame;
  }

  const std::shared_ptr<RenderContext> render_ = MakeRenderContext(ObservationConfig());
  FetchReach world_{WorldOptions{}};
  const std::vector<CameraView> cameras_{FindCamera(world_, "front"), FindCamera(world_, "side")};
};

TEST_F(GoalMarkerTest, LowestGoalsWhoseCapAloneIsAboveTheTableShowInFrontAndSideView) {
  render_->Attach(&world_);
  constexpr double kHalfRange = 0.15, kLowest = 0.385;  // m; the table's top is at 0.4
  const std::array<double, 3> grip = world_.arm().initial_grip();
  const std::vector<uint8_t> without = Draw(kOutOfSight);
  for (const double x : {-kHalfRange, 0.0, kHalfRange}) {
    for (const double y : {-kHalfRange, 0.0, kHalfRange}) {
      const std::vector<uint8_t> with = Draw({grip[0] + x, grip[1] + y, kLowest});
      int change = 0;
      for (size_t i = 0; i < with.size(); ++i) change += std::abs(with[i] - without[i]);
      EXPECT_GE(change, kThreePixels) << "goal at " << x << ", " << y << " from the grip";
    }
  }
}

}  // namespace
}  // namespace shoal::worlds
