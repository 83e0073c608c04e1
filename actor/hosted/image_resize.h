// SPDX-License-Identifier: Apache-2.0
// Converts images of a user's environment to the layout and size of a frame.
//
//   out[c, i, j] = round( sum over (y, x) of area(y, x; i, j) * in[y, x, c] / (H W) * (h w) )
//
// where area(y, x; i, j) is the overlap of pixel (y, x) and output pixel (i, j) when both images
// cover the same rectangle. A smaller output averages over areas; a larger output repeats pixels.
// The sums are exact integers, so all CPUs give the same bits.
//
// Shapes: `in` has H x W pixels in its declared layout; `out` is (C, h, w), row 0 = top. One thread
// per object.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/tasks/environment_description.h"

namespace shoal::hosted {

class ImageResize {
 public:
  // `grey`: RGB becomes one channel, the luma of ITU-R BT.601, as in frames of Shoal's worlds.
  // Throws Error (kUsage) if the image has more than 16 million pixels, because the sums would
  // overflow.
  ImageResize(const tasks::ImageLayout& layout, bool grey, int height, int width);

  int channels() const { return channels_; }
  // Writes the converted image to `frame`. CHECK: frame has channels() * height * width bytes.
  void Apply(const uint8_t* image, std::span<uint8_t> frame);

 private:
  // Source pixels first .. first + weights.size() - 1 of one row or column, with their weights in
  // one output pixel. The weights of one output pixel add up to the side of the source image in
  // pixels.
  struct Span {
    int first = 0;
    std::vector<uint32_t> weights;
  };
  static std::vector<Span> Spans(int from, int to);
  // Copies plane `channel` of the image, (H, W).
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
