// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/tools/contact_sheet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "actor/worlds/world_registry.h"
#include "common/base/error.h"
#include "common/tasks/task_registry.h"

namespace shoal::worlds {
namespace {

TEST(ContactSheet, ShowsEveryTaskWithEachOfItsCamerasInAllQualities) {
  std::set<std::string> shown;
  for (const auto& row : PlanContactSheet()) {
    for (const ContactSheetTile& tile : row) {
      for (const std::string& task : tile.tasks) {
        EXPECT_TRUE(shown.insert(task + " " + tile.camera + " " + tile.quality).second);
      }
    }
  }
  std::set<std::string> expected;
  for (const std::string& name : tasks::TaskNames()) {
    const auto world = MakeWorld(tasks::FindTask(name).world(), {});
    for (const CameraView& camera : world->cameras()) {
      for (const char* quality : {" fast", " native", " reference"}) {
        expected.insert(name + " " + camera.name + quality);
      }
    }
  }
  EXPECT_EQ(shown, expected);
}

TEST(ContactSheet, HoldsThePicturesUnderTheirLabels) {
  const ContactSheetRequest request{.side = 24};
  const ContactSheetRows rows{{{{"FetchReach", "FetchReachDense"}, "close", "fast"}}};
  const Picture sheet = DrawContactSheet(rows, request);
  EXPECT_EQ(sheet.height, 4 + 3 * 9 + 24 + 4);
  // The first picture: below one line per task and one for camera and quality.
  RenderRequest first;
  first.task = rows[0][0].tasks[0];
  first.camera = rows[0][0].camera;
  first.quality = rows[0][0].quality;
  first.width = first.height = request.side;
  const Picture tile = RenderTask(first);
  const int top = 4 + 9 * (static_cast<int>(rows[0][0].tasks.size()) + 1);
  for (int y = 0; y < tile.height; ++y) {
    const auto* ours = sheet.pixels.data() + 3 * ((top + y) * sheet.width + 4);
    const auto* theirs = tile.pixels.data() + 3 * y * tile.width;
    EXPECT_TRUE(std::equal(theirs, theirs + 3 * tile.width, ours)) << "row " << y;
  }
  // Its label: black on white, and nothing else.
  int ink = 0;
  for (int y = 4; y < top; ++y) {
    for (int x = 4; x < 60; ++x) {
      const uint8_t value = sheet.pixels[3 * (static_cast<size_t>(y) * sheet.width + x)];
      EXPECT_TRUE(value == 0 || value == 255);
      ink += value == 0;
    }
  }
  EXPECT_GT(ink, 50);
}

TEST(ContactSheet, RefusesASideThatShowsNothing) {
  for (const int side : {0, 15, 1025}) {
    try {
      DrawContactSheet({}, {.side = side});
      ADD_FAILURE() << side;
    } catch (const Error& error) {
      EXPECT_EQ(error.exit_code(), 2);
      EXPECT_THAT(error.what(), testing::HasSubstr(std::to_string(side)));
    }
  }
}

}  // namespace
}  // namespace shoal::worlds
