// SPDX-License-Identifier: Apache-2.0
// Small text in pictures: labels of contact sheets. Needs no font files.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace shoal::image {

// Each character takes a cell of this size in pixels; its glyph is 5 x 7 in the top left of it.
inline constexpr int kCellWidth = 6, kCellHeight = 9;

// Writes one line of printable ASCII ('?' for anything else), its top left at (x, y), into an
// interleaved image (height, width, 3), row 0 = top. Pixels outside the image are left out. CHECKs
// the pixel count.
void DrawText(std::string_view text, int x, int y, std::array<uint8_t, 3> colour, int width,
              int height, std::span<uint8_t> rgb);

}  // namespace shoal::image
