// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/tools/render_task.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>

#include "common/base/error.h"

namespace shoal::worlds {
namespace {

RenderRequest Request() {
  RenderRequest request;
  request.task = "FetchReachDense";
  request.camera = "close";
  request.width = 60;
  request.height = 40;
  request.quality = "fast";
  return request;
}

std::string Complaint(const RenderRequest& request) {
  try {
    RenderTask(request);
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    return error.what();
  }
  return "";
}

TEST(RenderTask, GivesAPictureOfTheAskedSizeInColour) {
  const Picture picture = RenderTask(Request());
  EXPECT_EQ(picture.width, 60);
  EXPECT_EQ(picture.height, 40);
  ASSERT_EQ(picture.pixels.size(), 60u * 40 * 3);
  // Interleaved: the top right corner is sky, a green of three different numbers.
  const uint8_t* corner = picture.pixels.data() + 59 * 3;
  EXPECT_NEAR(corner[0], 115, 8);
  EXPECT_NEAR(corner[1], 219, 8);
  EXPECT_NEAR(corner[2], 145, 8);
}

TEST(RenderTask, EqualRequestsGiveEqualPictures) {
  EXPECT_EQ(RenderTask(Request()).pixels, RenderTask(Request()).pixels);
}

TEST(RenderTask, TheSeedMovesTheTargetAndStepsMoveTheArm) {
  const Picture picture = RenderTask(Request());
  RenderRequest other = Request();
  other.seed = 2;
  EXPECT_NE(RenderTask(other).pixels, picture.pixels);
  other = Request();
  other.env_steps = 10;
  EXPECT_NE(RenderTask(other).pixels, picture.pixels);
}

TEST(RenderTask, SegmentsHaveOneColourEachAndTheSkyIsBlack) {
  RenderRequest request = Request();
  request.quality = "native";
  request.output = PainterOutput::kSegments;
  const Picture picture = RenderTask(request);
  std::map<std::array<uint8_t, 3>, int> colours;
  for (size_t i = 0; i < picture.pixels.size(); i += 3) {
    ++colours[{picture.pixels[i], picture.pixels[i + 1], picture.pixels[i + 2]}];
  }
  EXPECT_GE(colours.size(), 8u);
  EXPECT_LE(colours.size(), 40u);
  // The top right corner is sky.
  EXPECT_EQ(picture.pixels[59 * 3], 0);
  const bool black_is_sky = colours.contains({0, 0, 0});
  EXPECT_TRUE(black_is_sky);
}

TEST(RenderTask, DepthsAreGreyAndTheNearestIsWhite) {
  RenderRequest request = Request();
  request.quality = "native";
  request.output = PainterOutput::kDepths;
  const Picture picture = RenderTask(request);
  EXPECT_EQ(std::ranges::max(picture.pixels), 255);
  EXPECT_EQ(picture.pixels[59 * 3], 0);
  for (size_t i = 0; i < picture.pixels.size(); i += 3) {
    ASSERT_EQ(picture.pixels[i], picture.pixels[i + 2]);
  }
}

TEST(RenderTask, RefusesWhatItCannotDoByName) {
  RenderRequest request = Request();
  request.task = "FetchSleep";
  EXPECT_THAT(Complaint(request), testing::HasSubstr("FetchSleep"));
  request = Request();
  request.camera = "inside";
  EXPECT_THAT(Complaint(request), testing::HasSubstr("inside"));
  request = Request();
  request.quality = "best";
  EXPECT_THAT(Complaint(request), testing::HasSubstr("best"));
  request = Request();
  request.output = PainterOutput::kDepths;
  EXPECT_THAT(Complaint(request), testing::HasSubstr("native alone"));
  request = Request();
  request.width = 0;
  EXPECT_THAT(Complaint(request), testing::HasSubstr("width is 0"));
  request = Request();
  request.env_steps = 51;
  EXPECT_THAT(Complaint(request), testing::HasSubstr("51 env steps"));
}

}  // namespace
}  // namespace shoal::worlds
