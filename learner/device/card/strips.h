// SPDX-License-Identifier: Apache-2.0
// Strips: the outputs of a convolution's images, divided into groups of rows. The rows of x that a
// strip reads are in shared memory once, for all positions of the kernel and with the zeros around
// the map.
#pragma once

#include "learner/device/card/map_kernels.h"
#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/numbers.h"

namespace shoal::learner::kernels {

// Rows of the output of one image.
struct Strip {
  int image, first_row, pixels;
};

struct Strips {
  MapShape shape{};   // channels: a multiple of 8
  int32_t rows = 0;   // of a strip
  int32_t group = 0;  // channels that are in shared memory together; at most shape.channels

  // Strips of at most `most_pixels` pixels, which read at most `most_input` numbers of x. rows is 0
  // if even one row is too much.
  static Strips Of(const MapShape& shape, int group, int most_pixels, int most_input) {
    Strips strips{.shape = shape, .rows = 0, .group = Least(group, shape.channels)};
    int most = 0;
    while (most < shape.output_height && (most + 1) * shape.output_width <= most_pixels &&
           strips.InputRows(most + 1) * strips.width() * strips.step() <= most_input) {
      ++most;
    }
    // Strips of about equal size.
    if (most > 0) {
      strips.rows = int(CeilDivide(shape.output_height, CeilDivide(shape.output_height, most)));
    }
    return strips;
  }

  SHOAL_EVERYWHERE int of_image() const { return int(CeilDivide(shape.output_height, rows)); }
  SHOAL_EVERYWHERE int count() const { return shape.batch * of_image(); }
  // Width of x in shared memory.
  SHOAL_EVERYWHERE int width() const { return shape.width + 2 * shape.padding; }
  // Rows of x that `output_rows` rows of the output read.
  SHOAL_EVERYWHERE int InputRows(int output_rows) const {
    return (output_rows - 1) * shape.stride + shape.kernel;
  }
  // Numbers between pixels of x in shared memory. Neighbouring pixels are in different banks.
  SHOAL_EVERYWHERE int step() const { return group % 16 == 0 ? group + 8 : group; }

  SHOAL_KERNEL Strip At(int index) const {
    const int first = index % of_image() * rows;
    return {index / of_image(), first,
            Least(rows, shape.output_height - first) * shape.output_width};
  }
  // First pixel of the strip among the pixels of all outputs.
  SHOAL_KERNEL int64_t FirstPixel(const Strip& strip) const {
    return (int64_t(strip.image) * shape.output_height + strip.first_row) * shape.output_width;
  }
  // Distance in shared memory from the strip's first number to the number that pixel i of the
  // output reads at position (0, 0) of the kernel.
  SHOAL_KERNEL int Corner(int i) const {
    return (i / shape.output_width * width() + i % shape.output_width) * shape.stride * step();
  }
  // Distance from position (0, 0) to position `tap`.
  SHOAL_KERNEL int TapOffset(int tap) const {
    return (tap / shape.kernel * width() + tap % shape.kernel) * step();
  }

  // Copies `group` channels from first_channel on to shared memory, in pieces of eight numbers;
  // neighbouring threads copy neighbouring pieces. What does not exist is 0.
  template <int kThreads>
  SHOAL_KERNEL void Load(const uint16_t* x, const Strip& strip, int first_channel, int thread,
                         uint16_t* to) const {
    const int pieces = Least(shape.channels - first_channel, group) / 8;
    const int count = InputRows(strip.pixels / shape.output_width) * width() * pieces;
    const int top = strip.first_row * shape.stride - shape.padding;
    for (int i = thread; i < count; i += kThreads) {
      const int piece = i % pieces * 8, pixel = i / pieces;
      const int h = top + pixel / width(), w = pixel % width() - shape.padding;
      const bool exists = h >= 0 && h < shape.height && w >= 0 && w < shape.width;
      const int64_t at = (int64_t(strip.image) * shape.height + h) * shape.width + w;
      WriteEight(
          exists ? ReadEight(x + at * shape.channels + first_channel + piece) : Eight::Zero(),
          to + pixel * step() + piece);
    }
  }
};

}  // namespace shoal::learner::kernels
