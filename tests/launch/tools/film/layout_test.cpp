// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/film/layout.h"

#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

bool Overlap(const Box& a, const Box& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

// A picture with its caption.
Box WithCaption(const Box& box) {
  return {box.x, box.y - kCaptionHeight, box.width, box.height + kCaptionHeight};
}

struct Kind {
  int cameras, height, width;
};

TEST(FilmLayout, NothingOverlapsOrLiesOutside) {
  for (const Kind& kind :
       {Kind{0, 0, 0}, Kind{1, 84, 84}, Kind{2, 84, 84}, Kind{3, 84, 84}, Kind{5, 100, 64},
        Kind{9, 84, 84}, Kind{1, 8, 8}, Kind{2, 700, 300}, Kind{4, 1000, 1000}}) {
    SCOPED_TRACE(testing::Message() << kind.cameras << " x " << kind.height << " x " << kind.width);
    const FilmLayout layout = MakeFilmLayout(kind.cameras, kind.height, kind.width);
    ASSERT_EQ(layout.cameras.size(), size_t(kind.cameras));
    EXPECT_EQ(layout.width % 2, 0);
    EXPECT_EQ(layout.height % 2, 0);
    std::vector<Box> boxes{layout.title, layout.status, WithCaption(layout.view)};
    for (const Box& box : layout.cameras) boxes.push_back(WithCaption(box));
    for (size_t i = 0; i < boxes.size(); ++i) {
      EXPECT_GE(boxes[i].x, 0);
      EXPECT_GE(boxes[i].y, 0);
      EXPECT_LE(boxes[i].x + boxes[i].width, layout.width);
      EXPECT_LE(boxes[i].y + boxes[i].height, layout.height);
      for (size_t k = 0; k < i; ++k) EXPECT_FALSE(Overlap(boxes[i], boxes[k])) << i << " " << k;
    }
  }
}

TEST(FilmLayout, PicturesAreEnlargedByTheLargestWholeNumber) {
  const FilmLayout two = MakeFilmLayout(2, 84, 84);
  EXPECT_EQ(two.cameras[0].height, 3 * 84) << "2 x (3 x 84 + 24) <= 584 < 2 x (4 x 84 + 24)";
  EXPECT_EQ(two.cameras[0].width, 3 * 84);
  EXPECT_EQ(two.cameras[1].x, two.cameras[0].x) << "one below the other";
  EXPECT_EQ(two.cameras[1].y + two.cameras[1].height, two.view.y + two.view.height);
  const FilmLayout four = MakeFilmLayout(4, 84, 84);
  EXPECT_EQ(four.cameras[3].height, 3 * 84) << "in two columns";
  EXPECT_EQ(MakeFilmLayout(1, 700, 300).cameras[0].height, 350) << "halved";
}

}  // namespace
}  // namespace shoal::launch
