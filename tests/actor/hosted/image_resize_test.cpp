// SPDX-License-Identifier: Apache-2.0
#include "actor/hosted/image_resize.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/base/error.h"

namespace shoal::hosted {
namespace {

using testing::Each;
using testing::ElementsAre;

// The definition of the header, in doubles.
std::vector<uint8_t> Naive(const std::vector<uint8_t>& image, int from_h, int from_w, int to_h,
                           int to_w) {
  const auto overlap = [](int pixel, int from, int at, int to) {
    const double low = double(at) * from / to, high = double(at + 1) * from / to;
    return std::max(0.0, std::min(high, pixel + 1.0) - std::max(low, double(pixel)));
  };
  std::vector<uint8_t> out;
  for (int i = 0; i < to_h; ++i) {
    for (int j = 0; j < to_w; ++j) {
      double sum = 0;
      for (int y = 0; y < from_h; ++y) {
        for (int x = 0; x < from_w; ++x) {
          sum += overlap(y, from_h, i, to_h) * overlap(x, from_w, j, to_w) *
                 image[size_t(y * from_w + x)];
        }
      }
      sum *= double(to_h) * to_w / (double(from_h) * from_w);
      out.push_back(uint8_t(std::floor(sum + 0.5 + 1e-9)));
    }
  }
  return out;
}

std::vector<uint8_t> Apply(const tasks::ImageLayout& layout, bool grey, int height, int width,
                           const std::vector<uint8_t>& image) {
  ImageResize resize(layout, grey, height, width);
  std::vector<uint8_t> frame(size_t(resize.channels()) * size_t(height) * size_t(width));
  resize.Apply(image.data(), frame);
  return frame;
}

TEST(ImageResize, AveragesOverAreas) {
  // 4 x 4 to 2 x 2: each output pixel is the mean of four; halves are rounded up.
  const std::vector<uint8_t> image{0, 2, 10, 10, 4, 8, 10, 11, 1, 1, 0, 0, 0, 0, 255, 255};
  EXPECT_THAT(Apply({.height = 4, .width = 4, .channels = 1}, false, 2, 2, image),
              ElementsAre(4, 10, 1, 128));
}

TEST(ImageResize, IsItsDefinitionOnOddSizes) {
  std::mt19937 random(3);
  const int sizes[][4] = {{48, 48, 42, 42}, {13, 29, 8, 11}, {9, 8, 20, 24}, {42, 32, 17, 13}};
  for (const auto& [from_h, from_w, to_h, to_w] : sizes) {
    std::vector<uint8_t> image(size_t(from_h) * size_t(from_w));
    for (uint8_t& pixel : image) pixel = uint8_t(random());
    EXPECT_EQ(Apply({.height = from_h, .width = from_w, .channels = 1}, false, to_h, to_w, image),
              Naive(image, from_h, from_w, to_h, to_w))
        << from_h << "x" << from_w << " to " << to_h << "x" << to_w;
  }
}

TEST(ImageResize, APlainImageStaysWhite) {
  const std::vector<uint8_t> white(size_t{500} * 333, 255);
  EXPECT_THAT(Apply({.height = 500, .width = 333, .channels = 1}, false, 84, 84, white), Each(255));
}

TEST(ImageResize, BothLayoutsGiveTheSamePlanes) {
  // 8 x 8 with one colour: red 10, green 20, blue 30.
  std::vector<uint8_t> last, first;
  for (int i = 0; i < 64; ++i) last.insert(last.end(), {10, 20, uint8_t(30 + i)});
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i < 64; ++i) first.push_back(c < 2 ? uint8_t(10 * (c + 1)) : uint8_t(30 + i));
  }
  const auto frame = Apply({.height = 8, .width = 8, .channels = 3}, false, 8, 8, last);
  EXPECT_EQ(frame, first) << "channels come first in a frame";
  EXPECT_EQ(
      Apply({.height = 8, .width = 8, .channels = 3, .channels_first = true}, false, 8, 8, first),
      first);
  const auto grey = Apply({.height = 8, .width = 8, .channels = 3}, true, 8, 8, last);
  ASSERT_EQ(grey.size(), 64u);
  EXPECT_EQ(grey[0], (77 * 10 + 150 * 20 + 29 * 30 + 128) / 256);
  EXPECT_EQ(
      Apply({.height = 8, .width = 8, .channels = 3, .channels_first = true}, true, 8, 8, first),
      grey);
}

TEST(ImageResize, RefusesWhatWouldOverflow) {
  EXPECT_THROW(ImageResize({.height = 5000, .width = 5000, .channels = 1}, false, 84, 84), Error);
}

}  // namespace
}  // namespace shoal::hosted
