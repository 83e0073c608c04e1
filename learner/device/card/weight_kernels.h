// SPDX-License-Identifier: Apache-2.0
// The gradient of a convolution's weights and bias in bf16 (ConvolutionWeights of commands.h), by
// products of tiles:
//
//   dweight[n, u, v, c] = sum over pixels p of dy[p, n] x[p at (u, v), c],   dbias[n] = sum dy[p,
//   n]
//
// The outputs of each image are divided into strips of `strip_rows` rows. A block adds some strips
// for at most kGroup filters, kGroup channels and kTaps positions (u, v) of the kernel, one
// position for each warp; the last warp adds the bias. The rows of x that a strip reads are in
// shared memory once, for all positions. A second kernel adds the parts of the blocks. All sums
// have a fixed order.
#pragma once

#include "learner/device/card/strips.h"
#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/numbers.h"

namespace shoal::learner::kernels {

struct ConvolveWeightsByTiles {
  static constexpr int kTaps = 9, kGroup = 32;
  static constexpr int kThreads = (kTaps + 1) * kWarpThreads;
  // Most pixels of a strip, and most numbers of the rows of x that it reads.
  static constexpr int kPixels = 160, kInput = 12 * 1024;
  // Blocks of a launch, unless the groups are more: two for each multiprocessor of a card.
  static constexpr int kBlocks = 264;
  // Numbers between rows of dy in shared memory: rows 80 bytes apart are in different banks.
  static constexpr int kRow = kGroup + 8;

  struct alignas(16) Shared {
    uint16_t dy[kPixels][kRow];
    uint16_t x[kInput + 16];
    uint16_t ones[16];
    uint16_t corners[kPixels];  // Strips::Corner
  };

  Strips strips{};  // channels and filters: multiples of 8
  const uint16_t *x = nullptr, *dy = nullptr;
  // Results of one part, or of each of several parts in partials (parts, results()).
  float *weight_gradient = nullptr, *bias_gradient = nullptr;  // bias: may be null
  float* partials = nullptr;

  // Without rows if the shape needs too much shared memory.
  static Strips StripsOf(const MapShape& shape) {
    return Strips::Of(shape, kGroup, kPixels, kInput);
  }
  // Groups of positions, filters and channels, each of which some blocks compute.
  SHOAL_EVERYWHERE static int GroupsOf(const MapShape& shape) {
    return int(CeilDivide(shape.kernel * shape.kernel, kTaps) * CeilDivide(shape.filters, kGroup) *
               CeilDivide(shape.channels, kGroup));
  }

  SHOAL_EVERYWHERE const MapShape& shape() const { return strips.shape; }
  SHOAL_EVERYWHERE int taps() const { return shape().kernel * shape().kernel; }
  SHOAL_EVERYWHERE int groups() const { return GroupsOf(shape()); }
  SHOAL_EVERYWHERE int strips_of_part() const {
    return int(CeilDivide(strips.count(), Most(1, kBlocks / groups())));
  }
  SHOAL_EVERYWHERE int parts() const { return int(CeilDivide(strips.count(), strips_of_part())); }
  SHOAL_EVERYWHERE int64_t results() const { return shape().weights() + shape().filters; }
  SHOAL_EVERYWHERE int64_t PartialsSize() const { return parts() > 1 ? parts() * results() : 0; }
  SHOAL_EVERYWHERE int blocks() const { return groups() * parts(); }

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    const Place place = PlaceOf(block.index());
    typename Block::template PerWarp<TileSums<Block>> sums(block);
    block.Warps([&](int warp) { sums(warp).Clear(); });
    block.Threads([&](int thread) { Prepare(thread, &shared); });
    const int end = Least(strips.count(), (place.part + 1) * strips_of_part());
    for (int i = place.part * strips_of_part(); i < end; ++i) {
      const Strip strip = strips.At(i);
      block.Threads([&](int thread) {
        strips.Load<kThreads>(x, strip, place.first_channel, thread, shared.x);
        LoadGradient(place, strip, thread, &shared);
      });
      block.Warps([&](int warp) { sums(warp).Add(*this, place, strip, warp, shared); });
    }
    block.Warps([&](int warp) { Write(place, warp, sums(warp)); });
  }

 private:
  struct Place {
    int part, first_tap, first_filter, first_channel;
  };
  SHOAL_KERNEL Place PlaceOf(int index) const {
    const int tap_groups = int(CeilDivide(taps(), kTaps));
    const int filter_groups = int(CeilDivide(shape().filters, kGroup));
    const int in_part = index % groups();
    return {index / groups(), in_part % tap_groups * kTaps,
            in_part / tap_groups % filter_groups * kGroup,
            in_part / tap_groups / filter_groups * kGroup};
  }

  SHOAL_KERNEL static int Padded(int pixels) { return (pixels + 15) / 16 * 16; }

  SHOAL_KERNEL bool HasTap(const Place& place, int warp) const {
    return warp < kTaps && place.first_tap + warp < taps();
  }
  // One block of the part adds the bias.
  SHOAL_KERNEL bool HasBias(const Place& place, int warp) const {
    return warp == kTaps && bias_gradient != nullptr && place.first_tap == 0 &&
           place.first_channel == 0;
  }

  // (filters, channels) of one position, in tiles.
  template <class Block>
  struct TileSums {
    typename Block::Tile tiles[kGroup / 16][kGroup / 16];

    SHOAL_KERNEL void Clear() {
      for (auto& row : tiles) {
        for (auto& tile : row) tile.Clear();
      }
    }
    SHOAL_KERNEL void Add(const ConvolveWeightsByTiles& kernel, const Place& place,
                          const Strip& strip, int warp, const Shared& shared) {
      const bool bias = kernel.HasBias(place, warp);
      if (!bias && !kernel.HasTap(place, warp)) return;
      const uint16_t* position = shared.x + kernel.strips.TapOffset(place.first_tap + warp);
      for (int first = 0; first < Padded(strip.pixels); first += 16) {
        typename Block::Rows filters[kGroup / 16];
        for (int i = 0; i < kGroup / 16; ++i) {
          filters[i] = Block::ReadRows([&](int k) { return shared.dy[first + k] + 16 * i; });
        }
        for (int j = 0; j < kGroup / 16; ++j) {
          if (bias ? j > 0 : place.first_channel + 16 * j >= kernel.shape().channels) continue;
          const auto channels = Block::ReadRows([&](int k) {
            if (bias) return static_cast<const uint16_t*>(shared.ones);
            // dy is 0 for the pixels after the strip's, whose x may be anything.
            const int pixel = first + k < strip.pixels ? first + k : 0;
            return position + shared.corners[pixel] + 16 * j;
          });
          for (int i = 0; i < kGroup / 16; ++i) tiles[i][j].AddProduct(filters[i], channels);
        }
      }
    }
  };

  SHOAL_KERNEL void Prepare(int thread, Shared* shared) const {
    if (thread < 16) shared->ones[thread] = ToBf16(1);
    for (int i = thread; i < strips.rows * shape().output_width; i += kThreads) {
      shared->corners[i] = uint16_t(strips.Corner(i));
    }
  }

  // Copies the strip's dy to shared memory, in pieces of eight numbers. What does not exist is 0.
  SHOAL_KERNEL void LoadGradient(const Place& place, const Strip& strip, int thread,
                                 Shared* shared) const {
    constexpr int kPieces = kGroup / 8;
    const int64_t first = strips.FirstPixel(strip);
    for (int i = thread; i < Padded(strip.pixels) * kPieces; i += kThreads) {
      const int piece = i % kPieces * 8, pixel = i / kPieces;
      const int filter = place.first_filter + piece;
      const bool exists = pixel < strip.pixels && filter < shape().filters;
      WriteEight(
          exists ? ReadEight(dy + (first + pixel) * shape().filters + filter) : Eight::Zero(),
          shared->dy[pixel] + piece);
    }
  }

  template <class Block>
  SHOAL_KERNEL void Write(const Place& place, int warp, const TileSums<Block>& sums) const {
    const bool bias = HasBias(place, warp);
    if (!bias && !HasTap(place, warp)) return;
    float* weights = weight_gradient;
    float* biases = bias_gradient;
    if (parts() > 1) {
      weights = partials + place.part * results();
      biases = weights + shape().weights();
    }
    for (int i = 0; i < kGroup / 16; ++i) {
      for (int j = 0; j < kGroup / 16; ++j) {
        sums.tiles[i][j].ForEachPair([&](int m, int n, float first, float second) {
          const int filter = place.first_filter + 16 * i + m;
          const int channel = place.first_channel + 16 * j + n;
          if (filter >= shape().filters) return;
          if (bias) {
            if (j == 0 && n == 0) biases[filter] = first;
          } else if (channel < shape().channels) {
            const int64_t at =
                (int64_t(filter) * taps() + place.first_tap + warp) * shape().channels;
            weights[at + channel] = first;
            weights[at + channel + 1] = second;
          }
        });
      }
    }
  }
};

// Adds the parts of ConvolveWeightsByTiles.
struct AddWeightParts {
  static constexpr int kColumns = 32, kLanes = 8;
  static constexpr int kThreads = kColumns * kLanes;
  struct Shared {
    float sums[kLanes][kColumns];
  };

  const float* partials = nullptr;  // (parts, weights + biases)
  int32_t parts = 0;
  int64_t weights = 0, biases = 0;
  float *weight_gradient = nullptr, *bias_gradient = nullptr;  // bias: null if the parts have none

  int blocks() const {
    return int(CeilDivide(weights + (bias_gradient != nullptr ? biases : 0), kColumns));
  }

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    const int64_t stride = weights + biases;
    const int64_t count = bias_gradient != nullptr ? stride : weights;
    const int64_t first = int64_t(block.index()) * kColumns;
    block.Threads([&](int thread) {
      const int64_t column = first + thread % kColumns;
      float sum = 0;
      if (column < count) {
        for (int part = thread / kColumns; part < parts; part += kLanes) {
          sum += partials[part * stride + column];
        }
      }
      shared.sums[thread / kColumns][thread % kColumns] = sum;
    });
    block.Threads([&](int thread) {
      const int64_t column = first + thread;
      if (thread >= kColumns || column >= count) return;
      float sum = 0;
      for (int lane = 0; lane < kLanes; ++lane) sum += shared.sums[lane][thread];
      if (column < weights) {
        weight_gradient[column] = sum;
      } else {
        bias_gradient[column - weights] = sum;
      }
    });
  }
};

}  // namespace shoal::learner::kernels
