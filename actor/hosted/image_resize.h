// SPDX-License-Identifier: Apache-2.0
// Images of an environment's own, brought to the layout and size of a frame.
//
//   out[c, i, j] = round( sum over (y, x) of area(y, x; i, j) * in[y, x, c] / (H W) * (h w) )
//
// where area is that of pixel (y, x) which output pixel (i, j) covers, if both images are laid over
// each other. So a smaller image is the average over areas, and a larger one repeats pixels. Sums
// are exact in integers: the same bits on every CPU.
//
// Shapes: in as its layout says, H x W pixels; out (C, h, w), row 0 = top. Threads: each object is
// used by one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/tasks/environment_description.h"

namespace shoal::hosted {

class ImageResize {
 public:
  // `grey`: RGB becomes one channel, luma of ITU-R BT.601 as in frames of Shoal's worlds. Throws
  // Error (kUsage) on an image beyond 16 million pixels, where sums would overflow.
  ImageResize(const tasks::ImageLayout& layout, bool grey, int height, int width);

  int channels() const { return channels_; }
  // CHECK on a frame of another size than channels() * height * width.
  void Apply(const uint8_t* image, std::span<uint8_t> frame);

 private:
  // Source pixels first .. first + weights.size() - 1 with their share of one output pixel; the
  // weights of one output pixel add up to the source's side.
  struct Span {
    int first = 0;
    std::vector<uint32_t> weights;
  };
  static std::vector<Span> Spans(int from, int to);
  // Plane `channel` of the image, H x W.
  void TakePlane(const uint8_t* image, int channel);
  void TakeGrey(const uint8_t* image);
  void Shrink(std::span<uint8_t> plane);

  const tasks::ImageLayout layout_;
  const bool grey_;
  const int channels_, height_, width_;
  const std::vector<Span> rows_, columns_;
  std::vector<uint8_t> plane_;      // (H, W)
  std::vector<uint32_t> narrowed_;  // (H, w): sums over columns
  std::vector<uint32_t> sums_;      // (w): sums over the area of one output row
};

}  // namespace shoal::hosted
