// SPDX-License-Identifier: Apache-2.0
#include "common/image/png.h"

#include <png.h>

#include <cstring>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/files.h"

namespace shoal::image {

std::string EncodePng(int width, int height, int channels, std::span<const uint8_t> pixels) {
  CHECK(channels == 1 || channels == 3) << "PNG of " << channels << " channels";
  CHECK(width > 0 && height > 0) << width << " x " << height;
  CHECK(pixels.size() == size_t(width) * size_t(height) * size_t(channels))
      << pixels.size() << " bytes for " << width << " x " << height << " x " << channels;
  png_image image;
  std::memset(&image, 0, sizeof(image));
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = channels == 1 ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB;

  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string encoded(size, '\0');
  const int written = png_image_write_to_memory(&image, encoded.data(), &size, 0, pixels.data(),
                                                /*row_stride=*/0, nullptr);
  if (written == 0) throw RuntimeError("PNG encoding failed: {}", image.message);
  encoded.resize(size);
  return encoded;
}

void WritePng(const std::filesystem::path& path, int width, int height, int channels,
              std::span<const uint8_t> pixels) {
  WriteFileAtomically(path, EncodePng(width, height, channels, pixels));
}

}  // namespace shoal::image
