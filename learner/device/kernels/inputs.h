// SPDX-License-Identifier: Apache-2.0
// Inputs of networks: frames, columns of vectors, and labels.
// Dimensions: B rows, K*C channels of a stack of frames, (H, W) pixels, L labels.
#pragma once

#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/numbers.h"

namespace shoal::learner::kernels {

// Average pooling and scaling of frames, like common/nn/frame_pooling.h, from planes to NHWC:
//
//   out[b, i, j, c] = mean over the pool x pool window at (i*pool, j*pool) of in[b, c] / 255 +
//   shift
//
// Shapes: in (B, channels, height, width) u8; out (B, height/pool, width/pool, out_channels).
// Channels beyond `channels` become 0.
struct PoolFrames {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  const uint8_t* in = nullptr;
  Target out = {};
  int batch = 0, channels = 0, height = 0, width = 0;
  int pool = 1, out_channels = 0;
  float factor = 0;  // 1 / (255 pool^2)
  float shift = 0;

  SHOAL_EVERYWHERE int rows() const { return height / pool; }
  SHOAL_EVERYWHERE int columns() const { return width / pool; }
  SHOAL_EVERYWHERE int64_t pixels() const { return int64_t(batch) * rows() * columns(); }
  int blocks() const { return int(CeilDivide(pixels(), int64_t{kThreads} * span())); }
  bool operator==(const PoolFrames&) const = default;

  // Neighbouring threads read neighbouring windows of a plane and write neighbouring pixels.
  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    block.Threads([&](int thread) {
      const int64_t at = (int64_t(block.index()) * kThreads + thread) * span();
      if (at >= pixels()) return;
      const int j = int(at % columns()), i = int(at / columns() % rows());
      const int64_t b = at / columns() / rows(), plane = int64_t(height) * width;
      const uint8_t* corner = in + b * channels * plane + int64_t(i) * pool * width + j * pool;
      if (span() > 1) {
        ConvertSpan(corner, at);
      } else {
        for (int c = 0; c < out_channels; ++c) {
          out.Set(at * out_channels + c, c < channels ? Scaled(Window(corner + c * plane)) : 0.f);
        }
      }
    });
  }

 private:
  static constexpr int kSpanBytes = 4;  // that one instruction reads

  // Pixels of one thread: those whose windows have four bytes in each row, or one.
  SHOAL_EVERYWHERE int span() const {
    const bool in_fours = (pool == 1 || pool == 2) && width % kSpanBytes == 0;
    return in_fours && out.f32 == nullptr && out_channels % 8 == 0 ? kSpanBytes / pool : 1;
  }
  SHOAL_KERNEL float Scaled(int sum) const { return float(sum) * factor + shift; }

  // All channels of span() pixels, from `at` on.
  SHOAL_KERNEL void ConvertSpan(const uint8_t* corner, int64_t at) const {
    for (int first = 0; first < out_channels; first += 8) {
      Eight pixel_channels[kSpanBytes];
      SHOAL_UNROLL for (int k = 0; k < 8; ++k) {
        int sums[kSpanBytes] = {};
        const bool exists = first + k < channels;
        if (exists) AddSpan(corner + int64_t(first + k) * height * width, sums);
        for (int p = 0; p < kSpanBytes; ++p) {
          pixel_channels[p].numbers[k] = exists ? ToBf16(Scaled(sums[p])) : uint16_t(0);
        }
      }
      for (int p = 0; p < kSpanBytes; ++p) {
        if (p < span()) WriteEight(pixel_channels[p], out.bf16 + (at + p) * out_channels + first);
      }
    }
  }
  SHOAL_KERNEL void AddSpan(const uint8_t* corner, int* sums) const {
    for (int y = 0; y < pool; ++y) {
      const uint32_t bytes = ReadFourBytes(corner + y * width);
      for (int x = 0; x < kSpanBytes; ++x) {
        const int byte = int(bytes >> (8 * x) & 0xffu);
        if (pool == 1) {
          sums[x] += byte;
        } else {
          sums[x / 2] += byte;
        }
      }
    }
  }
  SHOAL_KERNEL int Window(const uint8_t* corner) const {
    int sum = 0;
    for (int y = 0; y < pool; ++y) {
      for (int x = 0; x < pool; ++x) sum += corner[y * width + x];
    }
    return sum;
  }
};

// A piece of CopyColumns: `count` columns from column `first` of `from`, which has `from_width`
// columns, to column `to_first` of `to`.
struct ColumnPiece {
  const float* from = nullptr;
  int from_width = 0, first = 0, count = 0;
  Target to = {};
  int to_width = 0, to_first = 0;
  bool adds = false;  // whether to add to the numbers that to.f32 has

  bool operator==(const ColumnPiece&) const = default;
};

// Copies columns of rows: joins, splits, and parts of networks' inputs. Pieces do not overlap in
// their targets, and no piece reads what another one writes.
struct CopyColumns {
  static constexpr int kThreads = kElementThreads;
  static constexpr int kMostPieces = 24;
  using Shared = NoShared;

  int rows = 0;
  int piece_count = 0;
  ColumnPiece pieces[kMostPieces] = {};

  void Add(const ColumnPiece& piece) { pieces[piece_count++] = piece; }
  SHOAL_EVERYWHERE int columns() const {
    int sum = 0;
    for (int i = 0; i < piece_count; ++i) sum += pieces[i].count;
    return sum;
  }
  int blocks() const { return BlocksForElements(int64_t{rows} * columns()); }
  bool operator==(const CopyColumns&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    const int width = columns();
    ForElements(block, block.index(), int64_t(rows) * width, [&](int64_t at) {
      const int64_t row = at / width;
      int column = int(at % width), i = 0;
      for (; column >= pieces[i].count; ++i) column -= pieces[i].count;
      const ColumnPiece& piece = pieces[i];
      const float value = piece.from[row * piece.from_width + piece.first + column];
      const int64_t to = row * piece.to_width + piece.to_first + column;
      piece.to.Set(to, piece.adds ? piece.to.f32[to] + value : value);
    });
  }
};

// to[b, j] = sum_f from[f, b, first + j] + addend[b, j] for functions f, for example the gradient
// of a part of the input of several Q functions. from (functions, rows, from_width); to and addend
// (rows, columns); addend may be null or to.f32.
struct SumColumns {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  int functions = 1, rows = 0, columns = 0;
  const float* from = nullptr;
  int from_width = 0, first = 0;
  const float* addend = nullptr;
  Target to = {};

  int blocks() const { return BlocksForElements(int64_t{rows} * columns); }
  bool operator==(const SumColumns&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForElements(block, block.index(), int64_t(rows) * columns, [&](int64_t at) {
      const float* of_first = from + at / columns * from_width + first + at % columns;
      float sum = *of_first;
      for (int f = 1; f < functions; ++f) sum += of_first[int64_t(f) * rows * from_width];
      to.Set(at, addend != nullptr ? sum + addend[at] : sum);
    });
  }
};

// labels[b, l] = (number - minus) / unit (learner/engine/columns.h). labels (B, L).
struct GatherLabels {
  static constexpr int kThreads = kElementThreads;
  static constexpr int kMostLabels = 64;
  using Shared = NoShared;

  // A column of the observed or the privileged vector; from.width 0: none.
  struct Column {
    const float* from = nullptr;
    int width = 0, at = 0;
    bool operator==(const Column&) const = default;
  };
  struct Label {
    Column number = {}, minus = {};
    bool operator==(const Label&) const = default;
  };

  int rows = 0, label_count = 0;
  float unit = 1;
  float* labels = nullptr;
  Label columns[kMostLabels] = {};

  int blocks() const { return BlocksForElements(int64_t{rows} * label_count); }
  bool operator==(const GatherLabels&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForElements(block, block.index(), int64_t(rows) * label_count, [&](int64_t at) {
      const int64_t row = at / label_count;
      const Label& label = columns[at % label_count];
      float number = Value(label.number, row);
      if (label.minus.width > 0) number -= Value(label.minus, row);
      labels[at] = number / unit;
    });
  }

 private:
  SHOAL_KERNEL static float Value(const Column& column, int64_t row) {
    return column.from[row * column.width + column.at];
  }
};

}  // namespace shoal::learner::kernels
