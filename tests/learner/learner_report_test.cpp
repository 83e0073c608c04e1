// SPDX-License-Identifier: Apache-2.0
#include "learner/learner_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>

#include "learner/agent/frame_figures.h"
#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

std::optional<double> ValueOf(const MetricsMessage& message, const std::string& name) {
  const auto at = std::ranges::find(message.names, name);
  if (at == message.names.end()) return std::nullopt;
  return message.values[size_t(at - message.names.begin())];
}

double SpreadOf(const BatchView& batch, const ObservationSpec& spec) {
  UpdateFigures figures;
  AddFrameFigures(batch, spec, 0, &figures);
  for (const auto& [figure, value] : figures.entries()) {
    if (figure == &kFrameSpread) return value;
  }
  return -1;
}

// Looking at frames takes the time of a part of an update.
TEST(LearnerReport, FramesAreThoseOfTheFirstOfSixteenUpdatesOfAReport) {
  const RunConfig run{SmallConfig(), SmallSpec()};
  LearnerReport report({.role = "learner"}, run);
  const RandomBatch random(run.spec, run.config.learner.batch, 1);
  const Batch batch{.view = random.View()};
  double expected = 0;
  for (uint64_t update = 0; update < 17; ++update) {
    for (size_t i = 0; i < batch.view.obs_frames.size(); ++i) {
      batch.view.obs_frames[i] = uint8_t(i % 2 == 0 ? 0 : update * update / 2);
    }
    if (update % 16 == 0) expected += SpreadOf(batch.view, run.spec) / 2;
    report.OnBatch(batch, update);
    report.OnUpdate({});
  }
  EXPECT_GT(expected, 10);
  EXPECT_EQ(ValueOf(report.Make({}), "frame_spread"), expected);
  report.OnBatch(batch, 17);
  report.OnUpdate({});
  EXPECT_EQ(ValueOf(report.Make({}), "frame_spread"), SpreadOf(batch.view, run.spec))
      << "the first of each report";
}

// An update whose outcome is known in a later report belongs to that report, with its batch.
TEST(LearnerReport, TheFiguresOfABatchAreReportedWithItsUpdate) {
  const RunConfig run{SmallConfig(), SmallSpec()};
  LearnerReport report({.role = "learner"}, run);
  const RandomBatch random(run.spec, run.config.learner.batch, 1);
  const Batch batch{.view = random.View()};
  const auto begin = [&](uint64_t update) {
    for (float& reward : batch.view.reward) reward = float(update);
    report.OnBatch(batch, update);
  };
  const auto end = [&](double loss) {
    UpdateFigures figures;
    figures.Set(kCriticLoss, loss);
    report.OnUpdate(figures);
  };
  begin(1);
  begin(2);
  begin(3);
  end(10);
  end(30);
  const MetricsMessage first = report.Make({});
  EXPECT_EQ(ValueOf(first, "critic_loss"), 20);
  EXPECT_EQ(ValueOf(first, "reward_mean"), 1.5);
  begin(4);
  end(50);
  const MetricsMessage second = report.Make({});
  EXPECT_EQ(ValueOf(second, "critic_loss"), 50);
  EXPECT_EQ(ValueOf(second, "reward_mean"), 3);
}

}  // namespace
}  // namespace shoal::learner
