// SPDX-License-Identifier: Apache-2.0
// Convolutions with a thread or a block for each result: in f32, where cuDNN might use TF32, and in
// bf16 where cuDNN has no engine. Formulas: commands.h.
#pragma once

#include "learner/device/card/map_kernels.h"
#include "learner/device/kernels/reduce.h"

namespace shoal::learner::kernels {

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
