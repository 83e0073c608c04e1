// SPDX-License-Identifier: Apache-2.0
// Converts uint8 frames to the network's input: average pooling, scaling to a range of 1 and
// conversion in one pass.
//
//   x[p, i, j] = mean over the pool x pool window at (i*pool, j*pool) of in[p] / 255 + shift
//
// Pixels that do not fill a window (H mod pool, W mod pool) are left out.
// Shapes: in (P, H, W) u8, P planes = images times channels; out (P, H/pool, W/pool) f32 or bf16.
// Threads: splits the planes over the current ThreadScope.
#pragma once

#include <cstdint>

namespace shoal::nn {

struct FrameShape {
  int planes = 0, height = 0, width = 0;  // P, H, W
};

void PoolFrames(const uint8_t* in, const FrameShape& shape, int pool, float shift, float* out);
void PoolFramesToBf16(const uint8_t* in, const FrameShape& shape, int pool, float shift,
                      uint16_t* out);

// Returns the standard deviation of the bytes of one image, averaged over the images, in grey
// levels. in: (images, bytes) u8.
double MeanFrameSpread(const uint8_t* in, int images, int bytes);

}  // namespace shoal::nn
