// SPDX-License-Identifier: Apache-2.0
#include "common/image/png.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cstring>
#include <vector>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::image {
namespace {

struct Decoded {
  int width = 0, height = 0;
  std::vector<uint8_t> pixels;
};

// libpng's own reader, asked for the format the bytes were written from.
Decoded Decode(const std::string& bytes, png_uint_32 format) {
  png_image image;
  std::memset(&image, 0, sizeof(image));
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
  EXPECT_EQ(image.format, format);
  image.format = format;
  Decoded decoded{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  decoded.pixels.resize(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, decoded.pixels.data(), 0, nullptr), 0);
  return decoded;
}

std::vector<uint8_t> Ramp(size_t size) {
  std::vector<uint8_t> pixels(size);
  for (size_t i = 0; i < size; ++i) pixels[i] = static_cast<uint8_t>(37 * i + 11);
  return pixels;
}

TEST(Png, ColourPixelsComeBackUnchanged) {
  const std::vector<uint8_t> pixels = Ramp(5 * 3 * 3);
  const Decoded decoded = Decode(EncodePng(5, 3, 3, pixels), PNG_FORMAT_RGB);
  EXPECT_EQ(decoded.width, 5);
  EXPECT_EQ(decoded.height, 3);
  EXPECT_EQ(decoded.pixels, pixels);
}

TEST(Png, GreyPixelsComeBackUnchanged) {
  const std::vector<uint8_t> pixels = Ramp(7 * 2);
  const Decoded decoded = Decode(EncodePng(7, 2, 1, pixels), PNG_FORMAT_GRAY);
  EXPECT_EQ(decoded.width, 7);
  EXPECT_EQ(decoded.height, 2);
  EXPECT_EQ(decoded.pixels, pixels);
}

TEST(Png, AFileHoldsTheEncodedBytes) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "picture.png";
  const std::vector<uint8_t> pixels = Ramp(4 * 4 * 3);
  WritePng(path, 4, 4, 3, pixels);
  EXPECT_EQ(ReadFile(path), EncodePng(4, 4, 3, pixels));
}

TEST(Png, AFolderThatIsNotThereIsAnError) {
  EXPECT_THROW(WritePng("/nonexistent/picture.png", 1, 1, 1, Ramp(1)), Error);
}

TEST(PngDeathTest, RefusesPixelsThatDoNotFit) {
  EXPECT_DEATH(EncodePng(4, 4, 3, Ramp(47)), "47 bytes");
  EXPECT_DEATH(EncodePng(2, 2, 2, Ramp(8)), "2 channels");
}

}  // namespace
}  // namespace shoal::image
