// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/film/picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace shoal::launch {
namespace {

using Colour = std::array<int, 3>;  // red, green, blue

// Two RGB cameras of 2 x 3 pixels, two frames.
ObservationSpec SmallSpec() {
  ObservationSpec spec;
  spec.task = "Task";
  spec.cameras = {"front", "side"};
  spec.channels = 6;
  spec.height = 2;
  spec.width = 3;
  spec.stack = 2;
  return spec;
}

Colour At(const FilmPicture& picture, int x, int y) {
  const uint8_t* pixel = picture.pixels().data() + y * picture.stride() + 4 * x;
  return {pixel[2], pixel[1], pixel[0]};
}

std::vector<uint8_t> Pixels(const FilmPicture& picture) {
  return {picture.pixels().begin(), picture.pixels().end()};
}

const std::vector<uint8_t> kView(size_t{3} * kFilmView * kFilmView, 77);

FilmText Text() {
  return {.title = "Task", .subtitle = "best", .episode = 1, .episodes = 2, .step = 3};
}

TEST(FilmPicture, ShowsTheNewestFramePixelByPixelWhereItsCameraIs) {
  FilmPicture picture(SmallSpec());
  std::vector<uint8_t> input(size_t{2} * 6 * 2 * 3, 200);  // the older frame is grey all over
  for (size_t i = 0; i < 36; ++i) input[36 + i] = static_cast<uint8_t>(100 + i);
  picture.Draw(Text(), input, kView);
  for (int camera = 0; camera < 2; ++camera) {
    const Box& box = picture.layout().cameras[static_cast<size_t>(camera)];
    ASSERT_EQ(box.width % 3, 0);
    const int factor = box.width / 3;
    ASSERT_GT(factor, 10);
    for (int y = 0; y < box.height; ++y) {
      for (int x = 0; x < box.width; ++x) {
        const int first = 100 + 18 * camera + 3 * (y / factor) + x / factor;
        ASSERT_EQ(At(picture, box.x + x, box.y + y), (Colour{first, first + 6, first + 12}))
            << camera << " " << y << " " << x;
      }
    }
  }
}

TEST(FilmPicture, ShowsTheViewAsItIs) {
  FilmPicture picture(SmallSpec());
  std::vector<uint8_t> view = kView;
  view[0] = 255;      // red, top left
  view.back() = 254;  // blue, bottom right
  picture.Draw(Text(), std::vector<uint8_t>(72), view);
  const Box& box = picture.layout().view;
  EXPECT_EQ(At(picture, box.x, box.y), (Colour{255, 77, 77}));
  EXPECT_EQ(At(picture, box.x + kFilmView - 1, box.y + kFilmView - 1), (Colour{77, 77, 254}));
}

TEST(FilmPicture, AGreyCameraIsGrey) {
  ObservationSpec spec = SmallSpec();
  spec.channels = 2;
  FilmPicture picture(spec);
  std::vector<uint8_t> input(24, 0);
  input[18] = 99;  // the newest frame of the second camera
  picture.Draw(Text(), input, kView);
  const Box& box = picture.layout().cameras[1];
  EXPECT_EQ(At(picture, box.x, box.y), (Colour{99, 99, 99}));
}

TEST(FilmPicture, EachFigureChangesThePicture) {
  FilmPicture picture(SmallSpec());
  const std::vector<uint8_t> input(72);
  picture.Draw(Text(), input, kView);
  const auto plain = Pixels(picture);
  picture.Draw(Text(), input, kView);
  EXPECT_EQ(Pixels(picture), plain);
  std::vector<FilmText> others(7, Text());
  others[0].title = "Other";
  others[1].subtitle = "step_000000001";
  others[2].episode = 2;
  others[3].step = 4;
  others[4].reward = -0.5F;
  others[5].episode_return = 1;
  others[6].success = true;
  for (size_t i = 0; i < others.size(); ++i) {
    picture.Draw(others[i], input, kView);
    EXPECT_NE(Pixels(picture), plain) << i;
  }
}

TEST(FilmPicture, WordsThatAreTooLongAreCutWithinTheirPlace) {
  ObservationSpec spec = SmallSpec();
  spec.cameras[0].assign(300, 'w').append("é");
  FilmPicture picture(spec);
  FilmText text = Text();
  for (int i = 0; i < 200; ++i) text.subtitle += "é";
  picture.Draw(text, std::vector<uint8_t>(72), kView);
  const FilmLayout& layout = picture.layout();
  const Colour paper = At(picture, 0, 0);
  // Between the camera's caption and the view's, and right of the title.
  for (int y = 0; y < layout.view.y; ++y) {
    const int gap = y < layout.title.height ? layout.width - 1 : layout.view.x - 2;
    ASSERT_EQ(At(picture, gap, y), paper) << y;
  }
}

TEST(FilmPicture, APolicyWithoutPixelsIsShownByTheViewAlone) {
  ObservationSpec spec;
  spec.task = "Task";
  FilmPicture picture(spec);
  EXPECT_TRUE(picture.layout().cameras.empty());
  picture.Draw(Text(), {}, kView);
  const Box& box = picture.layout().view;
  EXPECT_EQ(At(picture, box.x, box.y), (Colour{77, 77, 77}));
}

TEST(FilmPicture, OtherSizesAreABug) {
  FilmPicture picture(SmallSpec());
  EXPECT_DEATH(picture.Draw(Text(), std::vector<uint8_t>(71), kView), "71");
  EXPECT_DEATH(picture.Draw(Text(), std::vector<uint8_t>(72), std::vector<uint8_t>(3)), "3");
}

}  // namespace
}  // namespace shoal::launch
