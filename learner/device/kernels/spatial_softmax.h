// SPDX-License-Identifier: Apache-2.0
// Spatial softmax: the point of each channel near the largest values of its map. Formulas:
// common/nn/spatial_softmax.h.
//
// Dimensions: B rows, (h, w) of a map, C channels and Cp with padding. Maps are (B, h, w, Cp).
// Points are (B, 2, Cp): across, then down. Points of padding are 0.
#pragma once

#include <cmath>

#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/numbers.h"

namespace shoal::learner::kernels {

struct PointsShape {
  int batch = 0, height = 1, width = 1, channels = 0, padded = 0;  // B, h, w, C, Cp
  float sharpness = 1;

  bool operator==(const PointsShape&) const = default;
  SHOAL_EVERYWHERE int pixels() const { return height * width; }
  SHOAL_EVERYWHERE int64_t map_size() const { return int64_t(batch) * pixels() * padded; }
};

// Coordinates of pixels, from -1 to 1; 0 along a side of one pixel. They are computed without a
// division, which would take registers in each loop.
class PixelCoordinates {
 public:
  SHOAL_EVERYWHERE explicit PixelCoordinates(const PointsShape& shape)
      : width_(shape.width), across_(Of(shape.width)), down_(Of(shape.height)) {}
  SHOAL_EVERYWHERE float across(int pixel) const { return across_.At(pixel % width_); }
  SHOAL_EVERYWHERE float down(int pixel) const { return down_.At(pixel / width_); }

 private:
  struct Side {
    float first, step;
    SHOAL_EVERYWHERE float At(int i) const { return first + float(i) * step; }
  };
  static SHOAL_EVERYWHERE Side Of(int side) {
    return side == 1 ? Side{0, 0} : Side{-1, 2 / float(side - 1)};
  }

  int width_;
  Side across_, down_;
};

// One block for 32 channels of a row; eight threads share the pixels of a channel.
struct SpatialSoftmaxForward {
  static constexpr int kChannels = 32, kLanes = 8, kThreads = kChannels * kLanes;
  struct Sums {
    float total, across, down;
  };
  struct Shared {
    float largest[kLanes][kChannels];
    Sums sums[kLanes][kChannels];
  };

  PointsShape shape = {};
  Source x = {};                               // map
  Target points = {};                          // (B, 2, Cp)
  float *largest = nullptr, *total = nullptr;  // (B, Cp): of x, and sum of exp(s (x - largest))

  SHOAL_EVERYWHERE int groups() const { return int(CeilDivide(shape.padded, kChannels)); }
  int blocks() const { return shape.batch * groups(); }
  bool operator==(const SpatialSoftmaxForward&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    const int row = block.index() / groups(), first = block.index() % groups() * kChannels;
    const int64_t map = int64_t(row) * shape.pixels() * shape.padded;
    block.Threads([&](int thread) {
      const int channel = first + thread % kChannels, lane = thread / kChannels;
      if (channel >= shape.channels) return;
      float most = x[map + channel];
      for (int i = lane; i < shape.pixels(); i += kLanes) {
        most = Most(most, x[map + int64_t(i) * shape.padded + channel]);
      }
      shared.largest[lane][thread % kChannels] = most;
    });
    const PixelCoordinates coordinates(shape);
    block.Threads([&](int thread) {
      const int channel = first + thread % kChannels, lane = thread / kChannels;
      if (channel >= shape.channels) return;
      const float most = LargestOf(shared, thread % kChannels);
      Sums sums{0, 0, 0};
      for (int i = lane; i < shape.pixels(); i += kLanes) {
        const float value = x[map + int64_t(i) * shape.padded + channel];
        const float e = std::exp(shape.sharpness * (value - most));
        sums.total += e;
        sums.across += e * coordinates.across(i);
        sums.down += e * coordinates.down(i);
      }
      shared.sums[lane][thread % kChannels] = sums;
    });
    block.Threads([&](int thread) {
      if (thread < kChannels) Finish(shared, row, first, thread);
    });
  }

 private:
  static SHOAL_KERNEL float LargestOf(const Shared& shared, int channel) {
    float most = shared.largest[0][channel];
    for (int lane = 1; lane < kLanes; ++lane) most = Most(most, shared.largest[lane][channel]);
    return most;
  }

  SHOAL_KERNEL void Finish(const Shared& shared, int row, int first, int in_group) const {
    const int channel = first + in_group;
    if (channel >= shape.padded) return;
    const int64_t across = int64_t(row) * 2 * shape.padded + channel;
    if (channel >= shape.channels) {
      points.Set(across, 0);
      points.Set(across + shape.padded, 0);
      return;
    }
    Sums sums = shared.sums[0][in_group];
    for (int lane = 1; lane < kLanes; ++lane) {
      sums.total += shared.sums[lane][in_group].total;
      sums.across += shared.sums[lane][in_group].across;
      sums.down += shared.sums[lane][in_group].down;
    }
    points.Set(across, sums.across / sums.total);
    points.Set(across + shape.padded, sums.down / sums.total);
    const int64_t at = int64_t(row) * shape.padded + channel;
    largest[at] = LargestOf(shared, in_group);
    total[at] = sums.total;
  }
};

// dL/dx from dL/dpoints, for the latest forward pass. The gradient of padding is 0.
struct SpatialSoftmaxBackward {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  PointsShape shape = {};
  Source x = {};                                     // map
  const float* points = nullptr;                     // (B, 2, Cp), not rounded
  const float *largest = nullptr, *total = nullptr;  // (B, Cp)
  Source dpoints = {};                               // (B, 2, Cp)
  Target dx = {};                                    // map

  int blocks() const { return BlocksForElements(shape.map_size()); }
  bool operator==(const SpatialSoftmaxBackward&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    const PixelCoordinates coordinates(shape);
    ForElements(block, block.index(), shape.map_size(), [&](int64_t i) {
      const int channel = int(i % shape.padded);
      if (channel >= shape.channels) {
        dx.Set(i, 0);
        return;
      }
      const int64_t pixel_of_all = i / shape.padded;
      const int pixel = int(pixel_of_all % shape.pixels());
      const int64_t row = pixel_of_all / shape.pixels();
      const int64_t across = row * 2 * shape.padded + channel, down = across + shape.padded;
      const int64_t at = row * shape.padded + channel;
      const float g = dpoints[across] * (coordinates.across(pixel) - points[across]) +
                      dpoints[down] * (coordinates.down(pixel) - points[down]);
      const float e = std::exp(shape.sharpness * (x[i] - largest[at]));
      dx.Set(i, shape.sharpness / total[at] * e * g);
    });
  }
};

}  // namespace shoal::learner::kernels
