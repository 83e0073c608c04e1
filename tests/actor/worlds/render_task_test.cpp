// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/tools/render_task.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

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
  request.width = 0;
  EXPECT_THAT(Complaint(request), testing::HasSubstr("width is 0"));
  request = Request();
  request.env_steps = 51;
  EXPECT_THAT(Complaint(request), testing::HasSubstr("51 env steps"));
}

}  // namespace
}  // namespace shoal::worlds
