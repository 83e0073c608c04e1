// SPDX-License-Identifier: Apache-2.0
// PNG files, 8 bits per channel.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace shoal::image {

// PNG bytes of an image (height, width, channels) uint8, row 0 = top, interleaved; 1 channel is
// grey, 3 channels are RGB. CHECKs the number of channels, that the image is not empty, and the
// size of `pixels`.
std::string EncodePng(int width, int height, int channels, std::span<const uint8_t> pixels);

// Writes such an image to a file, atomically. Throws Error naming the path.
void WritePng(const std::filesystem::path& path, int width, int height, int channels,
              std::span<const uint8_t> pixels);

}  // namespace shoal::image
