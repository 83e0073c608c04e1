// SPDX-License-Identifier: Apache-2.0
// Conversion of the renderer's pixels to a frame.
#pragma once

#include <cstdint>
#include <span>

namespace shoal::worlds {

// pixels (H, W, 3): interleaved RGB, row 0 = bottom. planes (3, H, W) or (1, H, W): row 0 = top.
// Pixels and planes must not overlap. CHECK on sizes.

// Writes one plane per colour, red first.
void PackRgb(std::span<const uint8_t> pixels, int height, int width, std::span<uint8_t> planes);

// Writes one plane of luma: (77 R + 150 G + 29 B) / 256, rounded (Rec. 601).
void PackGrey(std::span<const uint8_t> pixels, int height, int width, std::span<uint8_t> plane);

// Writes the same luma of a frame: planes (3, H, W), plane (1, H, W).
void GreyOfPlanes(std::span<const uint8_t> planes, std::span<uint8_t> plane);

}  // namespace shoal::worlds
