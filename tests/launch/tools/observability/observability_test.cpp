// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/observability/observability.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/random.h"
#include "launch/tools/observability/frame_regression.h"
#include "launch/tools/observability/labelled_frames.h"
#include "tests/support/error_message.h"

namespace shoal::launch {
namespace {

using ::testing::HasSubstr;

bool Never() { return false; }

Config PushConfig() {
  Config config;
  config.task = "FetchPush";
  config.observation.width = config.observation.height = 32;
  config.observation.cameras = {"front"};
  config.sac.aux = {"object-grip", "object"};
  config.learner.batch = 32;
  return config;
}

TEST(LabelledFrames, ComeWithTheNumbersOfTheirMoment) {
  const LabelledFrames frames = CollectLabelledFrames(PushConfig(), 25);
  EXPECT_EQ(frames.labels, 6);
  EXPECT_EQ(frames.values.size(), 25u * 6);
  EXPECT_EQ(frames.frames.size(), 25u * 3 * 32 * 32);
  EXPECT_EQ(frames.spec.VectorSize(), 0);
  EXPECT_EQ(frames.episodes.front(), 0u);
  EXPECT_EQ(frames.episodes[9], 0u);
  EXPECT_EQ(frames.episodes[10], 1u);
  for (size_t i = 0; i < 25; ++i) {
    const float* object = &frames.values[i * 6 + 3];
    EXPECT_NEAR(object[2], 0.425, 0.01) << "on the table";
    EXPECT_LT(std::hypot(object[0] - 1.34, object[1] - 0.75), 0.25);
  }
  EXPECT_NE(frames.values[3], frames.values[10 * 6 + 3]) << "another episode's object";
}

// Frames that show where a bright column is, and labels that only half of which follow from it.
LabelledFrames Columns(int samples) {
  LabelledFrames frames;
  frames.spec.channels = 1;
  frames.spec.height = frames.spec.width = 32;
  frames.spec.cameras = {"front"};
  frames.spec.action_size = 1;
  frames.labels = 2;
  Random random(3);
  for (int i = 0; i < samples; ++i) {
    const auto column = size_t(random.Uniform() * 32);
    for (size_t p = 0; p < 32 * 32; ++p) {
      frames.frames.push_back(p % 32 == column ? 255 : 30);
    }
    frames.values.push_back(float(column) / 32);
    frames.values.push_back(float(random.Uniform()));
    frames.episodes.push_back(uint64_t(i / 10));
  }
  return frames;
}

TEST(FrameRegression, TellsWhatIsThereAndNothingElse) {
  Config config = PushConfig();
  config.replay.shift_pad = 0;
  config.learner.learning_rate = 1e-3;
  const RegressionErrors errors = RegressOnFrames(config, Columns(600), 200, Never);
  EXPECT_EQ(errors.trained, 480);
  EXPECT_EQ(errors.held_out, 120);
  EXPECT_NEAR(errors.of_mean[0], std::sqrt(1.0 / 12), 0.04);
  EXPECT_LT(errors.error[0], 0.25 * errors.of_mean[0]);
  EXPECT_GT(errors.error[1], 0.85 * errors.of_mean[1]) << "noise, learned by heart if at all";
}

TEST(FrameRegression, OneEpisodeLeavesNothingToHoldOut) {
  EXPECT_THAT(UsageMessage([] { RegressOnFrames(PushConfig(), Columns(10), 1, Never); }),
              HasSubstr("expected samples of at least 2"));
}

TEST(Observability, EachCameraAndEachPairHasARow) {
  ObservabilityRequest request;
  request.task = "FetchReach";
  request.labels = {"grip"};
  request.width = request.height = 24;
  request.samples = 40;
  request.updates = 2;
  int told = 0;
  const Observability result = MeasureObservability(
      request, [&](const ObservabilityRow&) { ++told; }, Never);
  ASSERT_EQ(result.rows.size(), 5u + 10u);  // front, side, close, gymnasium, wrist
  EXPECT_EQ(told, 15);
  EXPECT_EQ(result.rows[5].cameras, (std::vector<std::string>{"front", "side"}));
  EXPECT_EQ(ToJson(result).at("rows").size(), 15u);
  EXPECT_THAT(ToText(request, result.rows[5]), HasSubstr("front,side"));
  EXPECT_THAT(ToText(request, result.rows[5]), HasSubstr(" mm (the mean alone: "));
}

TEST(Observability, WhatIsNotThereIsNamed) {
  ObservabilityRequest request;
  request.task = "FetchReach";
  request.labels = {"object"};
  request.cameras = {{"front"}};
  const auto refusal = [&] {
    return UsageMessage([&] {
      MeasureObservability(
          request, [](const auto&) {}, Never);
    });
  };
  EXPECT_THAT(refusal(), HasSubstr("FetchReach records no block 'object'"));
  request.labels = {"grip"};
  request.cameras = {{"front", "frnot"}};
  EXPECT_THAT(refusal(), HasSubstr("frnot"));
  request.task = "FetchReech";
  EXPECT_THAT(refusal(), HasSubstr("FetchReech"));
}

}  // namespace
}  // namespace shoal::launch
