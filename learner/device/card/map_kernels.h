// SPDX-License-Identifier: Apache-2.0
// Kernels for the maps of convolutions on a card: bias, ReLU and types, which cuDNN's plain
// convolutions and cuBLASLt leave out. Their form is that of kernels/frame.h, so tests run them on
// the host.
//
// Maps are (B, H, W, C), outputs (B, OH, OW, N), weights (N, K, K, C); commands.h has the formulas.
#pragma once

#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/numbers.h"

namespace shoal::learner::kernels {

// Sizes of ConvolutionShape that kernels use.
struct MapShape {
  int32_t batch, height, width, channels;
  int32_t filters, kernel, stride, padding;
  int32_t output_height, output_width;

  SHOAL_EVERYWHERE int64_t inputs() const { return int64_t(batch) * height * width * channels; }
  SHOAL_EVERYWHERE int64_t pixels() const { return int64_t(batch) * output_height * output_width; }
  SHOAL_EVERYWHERE int64_t outputs() const { return pixels() * filters; }
  SHOAL_EVERYWHERE int64_t weights() const { return int64_t(filters) * kernel * kernel * channels; }
};

// An array of one type, read and written in place.
struct InPlace {
  float* f32 = nullptr;      // null: bf16
  uint16_t* bf16 = nullptr;  // used if f32 is null

  SHOAL_KERNEL float Get(int64_t i) const { return f32 != nullptr ? f32[i] : FromBf16(bf16[i]); }
  SHOAL_KERNEL void Set(int64_t i, float value) const {
    if (f32 != nullptr) {
      f32[i] = value;
    } else {
      bf16[i] = ToBf16(value);
    }
  }
};

// y[r, n] = y[r, n] + bias[n], then max(0, y) if `relu`. Row r begins at r * stride. `count` groups
// of rows: group g begins at g * step and has the bias at g * bias_step.
struct AddBias {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  InPlace y;
  const float* bias = nullptr;  // null: none
  int32_t relu = 0;
  int32_t rows = 0, columns = 0, stride = 0, count = 1;
  int64_t step = 0, bias_step = 0;

  int blocks() const { return BlocksForElements(size()); }
  SHOAL_EVERYWHERE int64_t size() const { return int64_t(count) * rows * columns; }

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForElements(block, block.index(), size(), [&](int64_t i) {
      const int64_t group = i / (int64_t(rows) * columns), in_group = i % (int64_t(rows) * columns);
      const int64_t row = in_group / columns, column = in_group % columns;
      const int64_t at = group * step + row * stride + column;
      float value = y.Get(at);
      if (bias != nullptr) value += bias[group * bias_step + column];
      y.Set(at, relu != 0 && value < 0 ? 0 : value);
    });
  }
};

// to[i] = from[i] in f32.
struct WidenToF32 {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  const uint16_t* from = nullptr;
  float* to = nullptr;
  int64_t size = 0;

  int blocks() const { return BlocksForElements(size); }

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForElements(block, block.index(), size, [&](int64_t i) { to[i] = FromBf16(from[i]); });
  }
};

// AddBias for a map (pixels, filters) in bf16, eight numbers for each thread. filters: a multiple
// of 8.
struct AddBiasToMap {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  uint16_t* y = nullptr;
  const float* bias = nullptr;  // null: none
  int32_t relu = 0, filters = 0;
  int64_t size = 0;

  int blocks() const { return BlocksForEights(size); }

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForEights(block, size, [&](int64_t first) {
      const int column = int(first % filters);
      Eight eight = ReadEight(y + first);
      for (int k = 0; k < 8; ++k) {
        float value = FromBf16(eight.numbers[k]);
        if (bias != nullptr) value += bias[column + k];
        eight.numbers[k] = ToBf16(relu != 0 && value < 0 ? 0 : value);
      }
      WriteEight(eight, y + first);
    });
  }
};

}  // namespace shoal::learner::kernels
