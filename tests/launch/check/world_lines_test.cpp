// SPDX-License-Identifier: Apache-2.0
#include "launch/check/world_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "launch/check/loopback.h"

namespace shoal::launch {
namespace {

using testing::HasSubstr;

TEST(WorldLines, APictureWithoutTheRobotFails) {
  const CheckLine empty = JudgePicture("front", 0);
  EXPECT_EQ(empty.verdict, Verdict::kFail);
  EXPECT_THAT(empty.finding, HasSubstr("front"));
  EXPECT_NE(empty.advice, "");
  EXPECT_EQ(JudgePicture("front", 0.01).verdict, Verdict::kFail) << "noise is not a robot";
  EXPECT_EQ(JudgePicture("front", 0.1).verdict, Verdict::kOk);
}

TEST(WorldLines, TheRobotIsInThePicturesOfTheTask) {
  const CheckLine line = LookAtPictures(Config{});
  EXPECT_EQ(line.verdict, Verdict::kOk) << line.finding;
  EXPECT_THAT(line.finding, testing::AllOf(HasSubstr("front"), HasSubstr("side")));
}

TEST(WorldLines, OpenGlIsLookedAtInQualityFast) {
  Config config;
  config.observation.quality = "native";
  const CheckLine line = LookAtOpenGl(config);
  EXPECT_EQ(line.name, "opengl");
  EXPECT_EQ(line.verdict, Verdict::kOk) << line.finding;
  EXPECT_THAT(line.finding, HasSubstr("quality fast"));
}

TEST(WorldLines, WhatOpenGlCannotDrawOnlyWarns) {
  Config config;
  config.observation.cameras = {"inside"};
  const CheckLine line = LookAtOpenGl(config);
  EXPECT_EQ(line.verdict, Verdict::kWarn);
  EXPECT_THAT(line.finding, HasSubstr("inside"));
  EXPECT_THAT(line.advice, HasSubstr("observation.quality=native"));
}

TEST(WorldLines, AnUnknownCameraIsAnError) {
  Config config;
  config.observation.cameras = {"inside"};
  EXPECT_THROW(LookAtPictures(config), Error);
}

TEST(WorldLines, PhysicsAgreesWithTheEmbeddedReference) {
  const CheckLine line = LookAtPhysics();
  EXPECT_EQ(line.verdict, Verdict::kOk) << line.finding;
  EXPECT_THAT(line.finding, HasSubstr("12 steps"));
}

TEST(Loopback, ARateBelowWhatIsNeededWarnsAndNothingAtAllFails) {
  LoopbackRate rate{.chunks = 100, .bytes = 100'000'000, .seconds = 0.25};
  EXPECT_DOUBLE_EQ(rate.MegabytesPerSecond(), 400);
  EXPECT_EQ(JudgeLoopback(rate, 325).verdict, Verdict::kOk);
  const CheckLine slow = JudgeLoopback(rate, 500);
  EXPECT_EQ(slow.verdict, Verdict::kWarn);
  EXPECT_THAT(slow.finding, testing::AllOf(HasSubstr("400 MB/s"), HasSubstr("500 MB/s")));
  EXPECT_THAT(slow.advice, HasSubstr("rmem_max"));
  EXPECT_EQ(JudgeLoopback({}, 325).verdict, Verdict::kFail);
}

}  // namespace
}  // namespace shoal::launch
