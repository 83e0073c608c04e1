// SPDX-License-Identifier: Apache-2.0
#include "launch/record/rollout_curve.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

std::vector<RolloutPoint> CurveOf(const std::string& lines, size_t most = 400) {
  const TemporaryFolder run;
  WriteFileAtomically(run.path() / "metrics.jsonl", lines);
  return ReadRolloutCurve(run.path(), most);
}

TEST(RolloutCurve, TakesTheCoordinatorsLinesAndTheLearnersUpdates) {
  const auto curve =
      CurveOf(R"({"t":1,"role":"coordinator","id":0,"env_steps":10,"elapsed_seconds":2})"
              "\n"
              R"({"t":2,"role":"learner","id":0,"env_steps":90,"updates":7})"
              "\n"
              R"({"t":2,"role":"actor","id":0,"env_steps":50,"rollout_success":1})"
              "\n"
              R"({"t":3,"role":"coordinator","id":0,"env_steps":100,"elapsed_seconds":4,)"
              R"("rollout_success":0.25,"rollout_return":-3.5})"
              "\n");
  ASSERT_EQ(curve.size(), 1u) << "before the first episode there is no point";
  EXPECT_EQ(curve[0].env_steps, 100);
  EXPECT_EQ(curve[0].updates, 7);
  EXPECT_EQ(curve[0].wall_seconds, 4);
  EXPECT_EQ(curve[0].success, 0.25);
  EXPECT_EQ(curve[0].episode_return, -3.5);
}

TEST(RolloutCurve, ReadsFilesOfOlderBuildsAndSkipsWhatIsNoLine) {
  const auto curve =
      CurveOf(R"({"t":2,"role":"learner","id":0,"env_steps":90,"updates":7})"
              "\n"
              R"({"t":3,"role":"coordinator","id":0,"elapsed_seconds":4,"rollout_success":0.5})"
              "\n"
              R"({"t":3,"role":"coordinator","rollout_success":)"
              "\n");
  ASSERT_EQ(curve.size(), 1u);
  EXPECT_EQ(curve[0].env_steps, 90) << "the learner's, where the coordinator's line has none";
  EXPECT_FALSE(curve[0].episode_return);
}

TEST(RolloutCurve, IsThinnedOverItsWholeLength) {
  std::string lines;
  for (int i = 0; i < 1000; ++i) {
    lines += fmt::format(R"({{"role":"coordinator","env_steps":{},"rollout_return":{}}})", i, -i);
    lines += '\n';
  }
  const auto curve = CurveOf(lines, 100);
  EXPECT_LE(curve.size(), 100u);
  EXPECT_GE(curve.size(), 50u);
  EXPECT_EQ(curve.front().env_steps, 0);
  EXPECT_GE(curve.back().env_steps, 980);
  for (size_t i = 2; i < curve.size(); ++i) {
    EXPECT_EQ(curve[i].env_steps - curve[i - 1].env_steps, curve[1].env_steps);
  }
}

TEST(RolloutCurve, ARunWithoutTheFileHasNone) {
  const TemporaryFolder run;
  EXPECT_TRUE(ReadRolloutCurve(run.path()).empty());
}

}  // namespace
}  // namespace shoal::launch
