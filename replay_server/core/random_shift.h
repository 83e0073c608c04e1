// SPDX-License-Identifier: Apache-2.0
// DrQ's random shift: pads each image by repeating its border, then crops the original size at a
// random offset. Padding and crop are a part of the copy from the ring, so each pixel is read once.
//
//   out[p, i, j] = in[p, clamp(i + dy, 0, H-1), clamp(j + dx, 0, W-1)]
//   dx, dy ~ Uniform{-pad, ..., pad}, one pair for each stack, the same for all its planes p
//
// Source: Kostrikov et al. 2020, arXiv:2004.13649, section 3.1. The grid samples of the source, at
// offsets of whole pixels, are exactly this crop.
#pragma once

#include <cstdint>

#include "common/base/random.h"

namespace shoal::replay {

struct Shift {
  int dx = 0, dy = 0;  // pixels
  bool operator==(const Shift&) const = default;
};

// Draws dx, then dy. Always draws two random numbers, so that later draws do not depend on `pad`.
Shift DrawShift(int pad, Random* random);

// Copies an image with the shift. in, out: (planes, height, width) uint8, row 0 = top; they must
// not overlap. CHECKs that |dx| < width and |dy| < height. Reentrant; allocates no memory.
void ShiftPlanes(const uint8_t* in, int planes, int height, int width, Shift shift, uint8_t* out);

}  // namespace shoal::replay
