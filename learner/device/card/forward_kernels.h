// SPDX-License-Identifier: Apache-2.0
// A convolution with its bias and ReLU in bf16 (ConvolutionForward of commands.h), by products of
// tiles. A block computes some strips of the outputs for kGroup filters; each warp has 16 pixels of
// a strip. The patch of a pixel and a filter are divided into pieces of eight adjacent channels at
// one position of the kernel; kPieces pieces of the filters are in shared memory at once.
#pragma once

#include "learner/device/card/strips.h"
#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/numbers.h"

namespace shoal::learner::kernels {

struct ConvolveForwardByTiles {
  static constexpr int kWarps = 8, kGroup = 32;
  static constexpr int kThreads = kWarps * kWarpThreads;
  // Most pixels of a strip, and most numbers of the rows of x that it reads.
  static constexpr int kPixels = 16 * kWarps, kInput = 12 * 1024;
  static constexpr int kPieces = 36;
  // Blocks of a launch, unless the groups are more: four for each multiprocessor of a card.
  static constexpr int kBlocks = 528;
  // Numbers between filters in shared memory: filters 592 bytes apart are in different banks.
  static constexpr int kRow = 8 * kPieces + 8;

  struct alignas(16) Shared {
    uint16_t x[kInput + 16];
    uint16_t filters[kGroup][kRow];
    uint16_t corners[kPixels];  // Strips::Corner
    uint16_t pieces[kPieces];   // distance of a piece of the patch from its corner
  };

  Strips strips{};  // channels and filters: multiples of 8
  const uint16_t *x = nullptr, *weight = nullptr;
  const float* bias = nullptr;  // null: none
  int32_t relu = 0;
  uint16_t* y = nullptr;

  // Without rows if the shape needs too much shared memory.
  static Strips StripsOf(const MapShape& shape) {
    return Strips::Of(shape, shape.channels, kPixels, kInput);
  }

  SHOAL_EVERYWHERE const MapShape& shape() const { return strips.shape; }
  SHOAL_EVERYWHERE int groups() const { return int(CeilDivide(shape().filters, kGroup)); }
  // Pieces of a filter.
  SHOAL_EVERYWHERE int pieces() const {
    return shape().kernel * shape().kernel * (shape().channels / 8);
  }
  SHOAL_EVERYWHERE int strips_of_block() const {
    return int(CeilDivide(strips.count(), Most(1, kBlocks / groups())));
  }
  SHOAL_EVERYWHERE int blocks() const {
    return groups() * int(CeilDivide(strips.count(), strips_of_block()));
  }

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    const int first_filter = block.index() % groups() * kGroup;
    const int first_strip = block.index() / groups() * strips_of_block();
    const int end = Least(strips.count(), first_strip + strips_of_block());
    typename Block::template PerWarp<TileSums<Block>> sums(block);
    block.Threads([&](int thread) {
      for (int i = thread; i < strips.rows * shape().output_width; i += kThreads) {
        shared.corners[i] = uint16_t(strips.Corner(i));
      }
    });
    for (int i = first_strip; i < end; ++i) {
      const Strip strip = strips.At(i);
      block.Warps([&](int warp) { sums(warp).Clear(); });
      for (int piece = 0; piece < pieces(); piece += kPieces) {
        if (piece == 0) {
          block.Threads([&](int thread) { strips.Load<kThreads>(x, strip, 0, thread, shared.x); });
        }
        if (i == first_strip || pieces() > kPieces) {
          block.Threads([&](int thread) { LoadFilters(first_filter, piece, thread, &shared); });
        }
        const int count = Least(pieces() - piece, kPieces);
        block.Warps([&](int warp) { sums(warp).Add(strip, count, warp, shared); });
      }
      block.Warps([&](int warp) { Write(strip, first_filter, warp, sums(warp)); });
    }
  }

 private:
  // (pixels, filters) of a warp.
  template <class Block>
  struct TileSums {
    typename Block::Tile tiles[kGroup / 16];

    SHOAL_KERNEL void Clear() {
      for (auto& tile : tiles) tile.Clear();
    }
    SHOAL_KERNEL void Add(const Strip& strip, int pieces, int warp, const Shared& shared) {
      if (16 * warp >= strip.pixels) return;
      for (int piece = 0; piece < pieces; piece += 2) {
        const auto pixels = Block::ReadColumns([&](int m, int h) {
          // Results for pixels after the strip's are not written.
          const int pixel = 16 * warp + m < strip.pixels ? 16 * warp + m : 0;
          return shared.x + shared.corners[pixel] + shared.pieces[piece + h];
        });
        for (int i = 0; i < kGroup / 16; ++i) {
          tiles[i].AddProduct(pixels, Block::ReadColumns([&](int m, int h) {
                                return shared.filters[16 * i + m] + (piece + h) * 8;
                              }));
        }
      }
    }
  };

  // Copies kPieces pieces of the filters to shared memory. What does not exist is 0.
  SHOAL_KERNEL void LoadFilters(int first_filter, int first_piece, int thread,
                                Shared* shared) const {
    for (int i = thread; i < kGroup * kPieces; i += kThreads) {
      const int filter = first_filter + i / kPieces, piece = first_piece + i % kPieces;
      const bool exists = filter < shape().filters && piece < pieces();
      WriteEight(
          exists ? ReadEight(weight + (int64_t(filter) * pieces() + piece) * 8) : Eight::Zero(),
          shared->filters[i / kPieces] + i % kPieces * 8);
    }
    const int of_channels = shape().channels / 8;
    for (int i = thread; i < kPieces; i += kThreads) {
      const int piece = first_piece + i;
      const int tap = piece < pieces() ? piece / of_channels : 0;
      shared->pieces[i] = uint16_t(strips.TapOffset(tap) + piece % of_channels * 8);
    }
  }

  template <class Block>
  SHOAL_KERNEL void Write(const Strip& strip, int first_filter, int warp,
                          const TileSums<Block>& sums) const {
    const int64_t first_pixel = strips.FirstPixel(strip);
    for (int i = 0; i < kGroup / 16; ++i) {
      sums.tiles[i].ForEachPair([&](int m, int n, float first, float second) {
        const int pixel = 16 * warp + m, filter = first_filter + 16 * i + n;
        if (pixel >= strip.pixels || filter >= shape().filters) return;
        const uint32_t low = ToBf16(Finish(first, filter));
        const uint32_t high = ToBf16(Finish(second, filter + 1));
        // The number of the filter is even, so the pair is aligned to 4 bytes.
        uint16_t* at = y + (first_pixel + pixel) * shape().filters + filter;
        *reinterpret_cast<uint32_t*>(at) = low | high << 16;
      });
    }
  }
  SHOAL_KERNEL float Finish(float sum, int filter) const {
    if (bias != nullptr) sum += bias[filter];
    return relu != 0 && sum < 0 ? 0.f : sum;
  }
};

}  // namespace shoal::learner::kernels
