// SPDX-License-Identifier: Apache-2.0
// Reads a picture of the golden files.
#pragma once

#include <png.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace shoal {

struct PngPicture {
  int width = 0, height = 0;
  std::vector<uint8_t> pixels;  // (H, W, 3), row 0 = top
};

inline PngPicture ReadRgbPng(const std::string& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&image, path.c_str()) == 0) {
    throw std::runtime_error(path + ": " + image.message);
  }
  image.format = PNG_FORMAT_RGB;
  PngPicture picture{int(image.width), int(image.height),
                     std::vector<uint8_t>(PNG_IMAGE_SIZE(image))};
  if (png_image_finish_read(&image, nullptr, picture.pixels.data(), 0, nullptr) == 0) {
    throw std::runtime_error(path + ": " + image.message);
  }
  return picture;
}

}  // namespace shoal
