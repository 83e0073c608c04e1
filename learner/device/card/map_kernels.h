// SPDX-License-Identifier: Apache-2.0
// Kernels for convolutions on a card: bias and ReLU, which cuDNN's plain convolutions leave out,
// and convolutions in f32, where cuDNN might use TF32. Their form is that of kernels/frame.h, so
// tests run them on the host.
//
// Maps are (B, H, W, C), outputs (B, OH, OW, N), weights (N, K, K, C); commands.h has the formulas.
#pragma once

#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/numbers.h"
#include "learner/device/kernels/reduce.h"

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

// ConvolutionForward, one output for each thread.
struct ConvolveForward {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  MapShape shape{};
  Source x, weight;
  const float* bias = nullptr;  // null: none
  int32_t relu = 0;
  InPlace y;

  int blocks() const { return BlocksForElements(shape.outputs()); }

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForElements(block, block.index(), shape.outputs(), [&](int64_t index) {
      const int64_t pixel = index / shape.filters;
      const int n = int(index % shape.filters);
      const int j = int(pixel % shape.output_width);
      const int i = int(pixel / shape.output_width % shape.output_height);
      const int64_t b = pixel / shape.output_width / shape.output_height;
      float sum = 0;
      for (int u = 0; u < shape.kernel; ++u) {
        const int h = i * shape.stride + u - shape.padding;
        if (h < 0 || h >= shape.height) continue;
        for (int v = 0; v < shape.kernel; ++v) {
          const int w = j * shape.stride + v - shape.padding;
          if (w < 0 || w >= shape.width) continue;
          const int64_t from = ((b * shape.height + h) * shape.width + w) * shape.channels;
          const int64_t by = ((int64_t(n) * shape.kernel + u) * shape.kernel + v) * shape.channels;
          for (int c = 0; c < shape.channels; ++c) sum += x[from + c] * weight[by + c];
        }
      }
      if (bias != nullptr) sum += bias[n];
      y.Set(index, relu != 0 && sum < 0 ? 0 : sum);
    });
  }
};

// ConvolutionData, one input for each thread.
struct ConvolveData {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  MapShape shape{};
  Source dy, weight;
  InPlace dx;

  int blocks() const { return BlocksForElements(shape.inputs()); }

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForElements(block, block.index(), shape.inputs(), [&](int64_t index) {
      const int c = int(index % shape.channels);
      const int64_t pixel = index / shape.channels;
      const int w = int(pixel % shape.width);
      const int h = int(pixel / shape.width % shape.height);
      const int64_t b = pixel / shape.width / shape.height;
      float sum = 0;
      for (int u = 0; u < shape.kernel; ++u) {
        const int top = h + shape.padding - u;
        if (top < 0 || top % shape.stride != 0 || top / shape.stride >= shape.output_height) {
          continue;
        }
        for (int v = 0; v < shape.kernel; ++v) {
          const int left = w + shape.padding - v;
          if (left < 0 || left % shape.stride != 0 || left / shape.stride >= shape.output_width) {
            continue;
          }
          const int64_t from =
              ((b * shape.output_height + top / shape.stride) * shape.output_width +
               left / shape.stride) *
              shape.filters;
          const int64_t by = (int64_t(u) * shape.kernel + v) * shape.channels + c;
          const int64_t filter = int64_t(shape.kernel) * shape.kernel * shape.channels;
          for (int n = 0; n < shape.filters; ++n) sum += dy[from + n] * weight[by + n * filter];
        }
      }
      dx.Set(index, sum);
    });
  }
};

// ConvolutionWeights, one weight or bias for each block.
struct ConvolveWeights {
  static constexpr int kThreads = 256;
  using Sum = Sums<1, float>;
  using Shared = Reduction<Sum, kThreads>;

  MapShape shape{};
  Source x, dy;
  float* weight_gradient = nullptr;
  float* bias_gradient = nullptr;  // null: none

  int blocks() const {
    return int(shape.weights() + (bias_gradient != nullptr ? shape.filters : 0));
  }

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    const int64_t index = block.index();
    if (index >= shape.weights()) return AddBiasGradient(block, shared, index - shape.weights());
    const int c = int(index % shape.channels);
    const int v = int(index / shape.channels % shape.kernel);
    const int u = int(index / shape.channels / shape.kernel % shape.kernel);
    const int64_t n = index / shape.channels / shape.kernel / shape.kernel;
    block.Threads([&](int thread) {
      Sum sum = Sum::Zero();
      for (int64_t pixel = thread; pixel < shape.pixels(); pixel += kThreads) {
        const int w = int(pixel % shape.output_width) * shape.stride + v - shape.padding;
        const int h = int(pixel / shape.output_width % shape.output_height) * shape.stride + u -
                      shape.padding;
        if (h < 0 || h >= shape.height || w < 0 || w >= shape.width) continue;
        const int64_t b = pixel / shape.output_width / shape.output_height;
        sum.values[0] += x[((b * shape.height + h) * shape.width + w) * shape.channels + c] *
                         dy[pixel * shape.filters + n];
      }
      shared.of_thread[thread] = sum;
    });
    const Sum total = Combine(block, shared);
    block.Threads([&](int thread) {
      if (thread == 0) weight_gradient[index] = total[0];
    });
  }

 private:
  template <class Block>
  SHOAL_KERNEL void AddBiasGradient(Block& block, Shared& shared, int64_t n) const {
    block.Threads([&](int thread) {
      Sum sum = Sum::Zero();
      for (int64_t pixel = thread; pixel < shape.pixels(); pixel += kThreads) {
        sum.values[0] += dy[pixel * shape.filters + n];
      }
      shared.of_thread[thread] = sum;
    });
    const Sum total = Combine(block, shared);
    block.Threads([&](int thread) {
      if (thread == 0) bias_gradient[n] = total[0];
    });
  }
};

}  // namespace shoal::learner::kernels
