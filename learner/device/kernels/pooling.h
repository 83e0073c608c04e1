// SPDX-License-Identifier: Apache-2.0
// Pooling of maps (B, H, W, C) to (B, h, w, C), and its backward passes. C includes padding, whose
// zeros stay zero. Formulas: common/nn/network_plan.h, common/nn/average_pool.h.
//
// A map has fewer than 2^31 numbers (common/nn/network_check.h), so indices are 32 bits: divisions
// of 64 bits would take registers. A gradient is gathered by the input that gets it, in a fixed
// order.
#pragma once

#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/numbers.h"

namespace shoal::learner::kernels {

struct PoolShape {
  int batch = 0, channels = 0, height = 0, width = 0;  // B, C, H, W
  int output_height = 0, output_width = 0;             // h, w
  int kernel = 1, stride = 1, padding = 0;             // of max pooling only

  bool operator==(const PoolShape&) const = default;
  SHOAL_EVERYWHERE int64_t inputs() const { return int64_t(batch) * height * width * channels; }
  SHOAL_EVERYWHERE int64_t outputs() const {
    return int64_t(batch) * output_height * output_width * channels;
  }
};

// A number of a map with `height` x `width` pixels.
struct MapPlace {
  int row, i, j, channel;

  SHOAL_KERNEL static MapPlace Of(int64_t number, int height, int width, int channels) {
    const int at = int(number), pixel = at / channels;
    return {pixel / width / height, pixel / width % height, pixel % width, at % channels};
  }
};

// The largest number of each window, without pixels outside of the map. NaN stays NaN.
struct MaxPoolForward {
  static constexpr int kThreads = kElementThreads;
  static constexpr int kMostKernel = 15;  // positions are 8 bits
  using Shared = NoShared;

  PoolShape shape = {};
  Source x = {};
  Target y = {};
  uint8_t* winners = nullptr;  // outputs: position u k + v of the first largest number; may be null

  int blocks() const { return BlocksForElements(shape.outputs()); }
  bool operator==(const MaxPoolForward&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForElements(block, block.index(), shape.outputs(), [&](int64_t at) {
      const MapPlace to = MapPlace::Of(at, shape.output_height, shape.output_width, shape.channels);
      const int top = to.i * shape.stride - shape.padding;
      const int left = to.j * shape.stride - shape.padding;
      int winner = -1;
      float most = 0;
      for (int u = Most(0, -top); u < Least(shape.kernel, shape.height - top); ++u) {
        const int row = (to.row * shape.height + top + u) * shape.width + left;
        for (int v = Most(0, -left); v < Least(shape.kernel, shape.width - left); ++v) {
          const float value = x[int64_t(row + v) * shape.channels + to.channel];
          if (winner >= 0 && !(value > most) && value == value) continue;
          most = value;
          winner = u * shape.kernel + v;
        }
      }
      y.Set(at, most);
      if (winners != nullptr) winners[at] = uint8_t(winner);
    });
  }
};

// dL/dx from dL/dy: the gradient of an output goes to its window's winner.
struct MaxPoolBackward {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  PoolShape shape = {};
  const uint8_t* winners = nullptr;  // of the latest forward pass
  Source dy = {};
  Target dx = {};

  int blocks() const { return BlocksForElements(shape.inputs()); }
  bool operator==(const MaxPoolBackward&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForElements(block, block.index(), shape.inputs(), [&](int64_t at) {
      const MapPlace to = MapPlace::Of(at, shape.height, shape.width, shape.channels);
      const int below = to.i + shape.padding, right = to.j + shape.padding;
      float sum = 0;
      // Windows whose first row is `below` or at most k - 1 rows above it; columns likewise.
      for (int i = Least(below / shape.stride, shape.output_height - 1);
           i >= 0 && below - i * shape.stride < shape.kernel; --i) {
        const int u = below - i * shape.stride;
        for (int j = Least(right / shape.stride, shape.output_width - 1);
             j >= 0 && right - j * shape.stride < shape.kernel; --j) {
          const int v = right - j * shape.stride;
          const int pixel = (to.row * shape.output_height + i) * shape.output_width + j;
          const int64_t from = int64_t(pixel) * shape.channels + to.channel;
          if (int(winners[from]) == u * shape.kernel + v) sum += dy[from];
        }
      }
      dx.Set(at, sum);
    });
  }
};

// Inputs of an output of average pooling along one side, or outputs of an input: the relation is
// symmetric, because `i` of `from` and `j` of `to` are related if the intervals [i/from,
// (i+1)/from) and [j/to, (j+1)/to) overlap.
struct AverageWindow {
  int begin, end;

  SHOAL_KERNEL static AverageWindow Of(int i, int from, int to) {
    return {i * to / from, ((i + 1) * to + from - 1) / from};
  }
  SHOAL_KERNEL int size() const { return end - begin; }
};

struct AveragePoolForward {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  PoolShape shape = {};
  Source x = {};
  Target y = {};

  int blocks() const { return BlocksForElements(shape.outputs()); }
  bool operator==(const AveragePoolForward&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForElements(block, block.index(), shape.outputs(), [&](int64_t at) {
      const MapPlace to = MapPlace::Of(at, shape.output_height, shape.output_width, shape.channels);
      const AverageWindow rows = AverageWindow::Of(to.i, shape.output_height, shape.height);
      const AverageWindow columns = AverageWindow::Of(to.j, shape.output_width, shape.width);
      float sum = 0;
      for (int u = rows.begin; u < rows.end; ++u) {
        for (int v = columns.begin; v < columns.end; ++v) {
          const int pixel = (to.row * shape.height + u) * shape.width + v;
          sum += x[int64_t(pixel) * shape.channels + to.channel];
        }
      }
      y.Set(at, sum / float(rows.size() * columns.size()));
    });
  }
};

struct AveragePoolBackward {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  PoolShape shape = {};
  Source dy = {};
  Target dx = {};

  int blocks() const { return BlocksForElements(shape.inputs()); }
  bool operator==(const AveragePoolBackward&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForElements(block, block.index(), shape.inputs(), [&](int64_t at) {
      const MapPlace to = MapPlace::Of(at, shape.height, shape.width, shape.channels);
      const AverageWindow rows = AverageWindow::Of(to.i, shape.height, shape.output_height);
      const AverageWindow columns = AverageWindow::Of(to.j, shape.width, shape.output_width);
      float sum = 0;
      for (int i = rows.begin; i < rows.end; ++i) {
        const int window_rows = AverageWindow::Of(i, shape.output_height, shape.height).size();
        for (int j = columns.begin; j < columns.end; ++j) {
          const int window =
              window_rows * AverageWindow::Of(j, shape.output_width, shape.width).size();
          const int pixel = (to.row * shape.output_height + i) * shape.output_width + j;
          sum += dy[int64_t(pixel) * shape.channels + to.channel] / float(window);
        }
      }
      dx.Set(at, sum);
    });
  }
};

}  // namespace shoal::learner::kernels
