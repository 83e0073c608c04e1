// SPDX-License-Identifier: Apache-2.0
// PNG files, 8 bits per channel.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace shoal::image {

// PNG bytes of an image (H, W, C) uint8, row 0 = top, interleaved; C = 1 grey, 3 RGB. CHECK on
// other C, on empty images and on a pixel count that does not fit.
std::string EncodePng(int width, int height, int channels, std::span<const uint8_t> pixels);

// The same into a file, atomically. Throws Error naming the path.
void WritePng(const std::filesystem::path& path, int width, int height, int channels,
              std::span<const uint8_t> pixels);

}  // namespace shoal::image
