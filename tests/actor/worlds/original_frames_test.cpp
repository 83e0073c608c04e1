// SPDX-License-Identifier: Apache-2.0
// Compares Shoal's pictures of Hopper and the Control Suite with those of the original models:
// camera 0, 84x84.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstdlib>

#include "actor/worlds/reacher_easy.h"
#include "actor/worlds/render_context.h"
#include "actor/worlds/world_registry.h"
#include "tests/actor/worlds/parity/state_reference.h"
#include "tests/common/image/png_file.h"
#include "tests/support/paths.h"

namespace shoal::worlds {
namespace {

constexpr int kSide = 84;
constexpr size_t kPlane = kSide * kSide;

struct Original {
  const char* world;      // "Hopper-v5"
  const char* picture;    // "hopper": golden/frames/hopper_00.png
  const char* reference;  // golden/reference/..., whose states are shown
};

const Original kOriginals[] = {
    {"Hopper-v5", "hopper", "hopper_gymnasium_const_a2"},
    {"cartpole_swingup", "cartpole_swingup", "dmc_cartpole_swingup_random0"},
    {"reacher_easy", "reacher_easy", "dmc_reacher_easy_random0"},
    {"cheetah_run", "cheetah_run", "dmc_cheetah_run_random0"},
    {"ball_in_cup_catch", "ball_in_cup_catch", "dmc_ball_in_cup_catch_random0"},
    {"finger_spin", "finger_spin", "dmc_finger_spin_random0"},
    {"walker_walk", "walker_walk", "dmc_walker_walk_random0"},
};

class OriginalFrames : public testing::TestWithParam<Original> {
 protected:
  // Mean over pixels and channels of |ours - original|, in grey levels, after `step` control steps.
  double Error(const std::string& quality, int step) const {
    const StateTrajectory reference =
        ReadStateReference(GoldenPath("reference/") + GetParam().reference + ".json");
    const auto world = MakeWorld(GetParam().world, {});
    if (reference.target) dynamic_cast<ReacherEasy&>(*world).PlaceTarget(*reference.target);
    const auto& qpos = step == 0 ? reference.reset.qpos
                                 : reference.steps.at(static_cast<size_t>(step) - 1).after.qpos;
    std::copy(qpos.begin(), qpos.end(), world->data().qpos);
    mj_forward(&world->model(), &world->data());

    ObservationConfig observation;
    observation.height = observation.width = kSide;
    observation.quality = quality;
    RenderContext context(observation);
    context.Attach(world.get());
    std::vector<uint8_t> frame(3 * kPlane);
    context.Render(world.get(), world->cameras().first(1), frame);

    const PngPicture original = ReadRgbPng(GoldenPath("frames/") + GetParam().picture +
                                           (step == 0 ? "_00.png" : "_50.png"));
    EXPECT_EQ(original.pixels.size(), frame.size());
    double sum = 0;
    for (size_t i = 0; i < frame.size(); ++i) {
      sum += std::abs(int{frame[i % 3 * kPlane + i / 3]} - int{original.pixels[i]});
    }
    return sum / static_cast<double>(frame.size());
  }
};

TEST_P(OriginalFrames, ReferenceQualityIsWithinOneGreyLevel) {
  for (const int step : {0, 50}) {
    const double error = Error("reference", step);
    RecordProperty("grey_levels_after_" + std::to_string(step), std::to_string(error));
    EXPECT_LE(error, 1) << "after step " << step;
  }
}

TEST_P(OriginalFrames, FastQualityIsWithinTenGreyLevels) {
  for (const int step : {0, 50}) {
    const double error = Error("fast", step);
    RecordProperty("grey_levels_after_" + std::to_string(step), std::to_string(error));
    EXPECT_LE(error, 10) << "after step " << step;
  }
}

TEST_P(OriginalFrames, NativeQualityIsWithinTenGreyLevels) {
  for (const int step : {0, 50}) {
    const double error = Error("native", step);
    RecordProperty("grey_levels_after_" + std::to_string(step), std::to_string(error));
    EXPECT_LE(error, 10) << "after step " << step;
  }
}

INSTANTIATE_TEST_SUITE_P(Tasks, OriginalFrames, testing::ValuesIn(kOriginals),
                         [](const auto& original) { return std::string(original.param.picture); });

}  // namespace
}  // namespace shoal::worlds
