// SPDX-License-Identifier: Apache-2.0
// Small text in pictures: labels of contact sheets. Needs no font files.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace shoal::image {

// Each character has a cell of this size in pixels. The glyph of 5 x 7 pixels is in the top left
// corner of the cell.
inline constexpr int kCellWidth = 6, kCellHeight = 9;

// Draws one line of text into an interleaved image (height, width, 3), row 0 = top. The top left
// corner of the text is at (x, y). A character that is not printable ASCII is drawn as '?'. Pixels
// outside of the image are left out. CHECKs the size of `rgb`.
void DrawText(std::string_view text, int x, int y, std::array<uint8_t, 3> colour, int width,
              int height, std::span<uint8_t> rgb);

}  // namespace shoal::image
