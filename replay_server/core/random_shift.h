// SPDX-License-Identifier: Apache-2.0
// DrQ random shift: pads each image by replicating its border, then crops back at a random offset.
// Fused with the copy out of the ring: padding and crop are one read of each pixel.
//
//   out[p, i, j] = in[p, clamp(i + dy, 0, H-1), clamp(j + dx, 0, W-1)]
//   dx, dy ~ Uniform{-pad, ..., pad}, one pair per image, shared by all planes p of its stack.
//
// Source: Kostrikov et al. 2020, arXiv:2004.13649, section 3.1; their grid samples of whole-pixel
// offsets are exactly this crop.
#pragma once

#include <cstdint>

#include "common/base/random.h"

namespace shoal::replay {

struct Shift {
  int dx = 0, dy = 0;  // pixels
  bool operator==(const Shift&) const = default;
};

// Draws dx, then dy. Always takes two random numbers, whatever the pad, so that later draws do not
// depend on the pad.
Shift DrawShift(int pad, Random* random);

// in, out: (planes, height, width) uint8, row 0 = top. May not overlap. |dx| < width, |dy| < height
// (CHECKed). Reentrant; no allocation.
void ShiftPlanes(const uint8_t* in, int planes, int height, int width, Shift shift, uint8_t* out);

}  // namespace shoal::replay
