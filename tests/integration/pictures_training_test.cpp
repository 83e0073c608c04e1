// SPDX-License-Identifier: Apache-2.0
// Short trainings of the real programs on every kind of observation with pictures: goal modes,
// proprioception, colours, stacks, numbers of cameras and sizes, copies, their shifts and n-step
// returns, each value with others at least once.
#include <gtest/gtest.h>

#include "tests/support/training_run.h"

namespace shoal {
namespace {

struct PictureKind {
  const char* name;
  const char* goal_mode;
  bool proprioception, grey;
  int stack;
  const char* cameras;
  int channels, height, width;
  int copies, n_step;
  int target_shifts = 0, critic_shifts = 0;
};

const PictureKind kKinds[] = {
    {"rgb", "none", false, false, 1, R"(["front"])", 3, 84, 84, 1, 1},
    {"grey_stack_of_four", "desired", true, true, 4, R"(["front","side"])", 2, 64, 64, 2, 1, 2, 1},
    {"three_cameras", "both", false, false, 2, R"(["front","side","close"])", 9, 100, 100, 1, 3},
    {"image_goals", "image", true, false, 2, R"(["front","side"])", 6, 48, 48, 1, 1},
    {"wide", "both", true, true, 3, R"(["gymnasium"])", 1, 64, 100, 2, 5, 1, 2},
};

class PicturesTraining : public testing::TestWithParam<PictureKind> {};

TEST_P(PicturesTraining, UpdatesAndEvaluates) {
  const PictureKind& kind = GetParam();
  const auto text = [](bool value) { return std::string(value ? "true" : "false"); };
  const TrainingRun run;
  const ProgramResult result = run.Train(
      TrainingRun::FromPixels({{"observation.goal_mode", kind.goal_mode},
                               {"observation.proprioception", text(kind.proprioception)},
                               {"observation.grey", text(kind.grey)},
                               {"observation.stack", std::to_string(kind.stack)},
                               {"observation.cameras", kind.cameras},
                               {"observation.height", std::to_string(kind.height)},
                               {"observation.width", std::to_string(kind.width)},
                               {"replay.shift_pad", "4"},
                               {"replay.copies", std::to_string(kind.copies)},
                               {"replay.target_shifts", std::to_string(kind.target_shifts)},
                               {"replay.critic_shifts", std::to_string(kind.critic_shifts)},
                               {"replay.n_step", std::to_string(kind.n_step)}}));
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  const auto meta = run.Json("meta.json");
  ExpectBalanced(meta);
  EXPECT_GT(meta.at("updates").get<int64_t>(), 20);
  const auto spec = run.Json("config.json").at("spec");
  EXPECT_EQ(spec.at("channels"), kind.channels);
  EXPECT_EQ(spec.at("height"), kind.height);
  EXPECT_EQ(spec.at("width"), kind.width);
  EXPECT_EQ(spec.at("stack"), kind.stack);
  EXPECT_EQ(spec.contains("goal_picture"), std::string(kind.goal_mode) == "image");
  EXPECT_EQ(run.Json("eval/final.json").at("aggregate").at("episodes"), 2);
}

INSTANTIATE_TEST_SUITE_P(Kinds, PicturesTraining, testing::ValuesIn(kKinds),
                         [](const auto& kind) { return std::string(kind.param.name); });

}  // namespace
}  // namespace shoal
