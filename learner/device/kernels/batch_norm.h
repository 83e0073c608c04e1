// SPDX-License-Identifier: Apache-2.0
// Batch normalisation of a map's channels, with the addition of another map and ReLU, and its
// backward pass. Formulas: common/nn/batch_norm.h.
//
// Dimensions: n rows, the pixels of a batch, and C channels with padding, whose zeros stay zero.
// Maps are (n, C); values per channel are (C) f32.
#pragma once

#include "learner/device/kernels/column_sums.h"
#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/layers.h"
#include "learner/device/kernels/numbers.h"

namespace shoal::learner::kernels {

// Work on all numbers of a map. Each thread computes some rows of one channel, so values of the
// channel are computed once for these rows, and no division finds the channel of a number.
struct ChannelWork {
  static constexpr int kChannels = 32, kLanes = 8;  // of a block
  static constexpr int kThreads = kChannels * kLanes;
  static constexpr int kRows = 64;  // of a block

  int64_t rows = 0;
  int channels = 0;

  bool operator==(const ChannelWork&) const = default;
  SHOAL_EVERYWHERE int groups() const { return int(CeilDivide(channels, kChannels)); }
  int blocks() const { return groups() * int(CeilDivide(rows, kRows)); }

  // Calls body(channel, first, end, step) for each thread with work. The thread's numbers of the
  // map are first, first + step, ... below end.
  template <class Block, class Body>
  SHOAL_KERNEL void Run(Block& block, const Body& body) const {
    const int group = block.index() % groups();
    const int64_t begin = int64_t(block.index() / groups()) * kRows;
    const int64_t end = Least(rows, begin + kRows);
    block.Threads([&](int thread) {
      const int channel = group * kChannels + thread % kChannels;
      if (channel >= channels) return;
      body(channel, (begin + thread / kChannels) * channels + channel, end * channels,
           int64_t(kLanes) * channels);
    });
  }
};

SHOAL_KERNEL float BatchNormScale(float variance) { return 1.f / std::sqrt(variance + 1e-5f); }

// mean_c over the rows.
struct ChannelMeans {
  static constexpr int kThreads = ColumnSums::kThreads;
  using Shared = ColumnSums::Shared<1>;

  ColumnSums sums = {};
  Source x = {};
  float inverse = 0;  // 1 / n
  float* mean = nullptr;

  int blocks() const { return sums.blocks(); }
  bool operator==(const ChannelMeans&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    sums.Run<1>(
        block, shared,
        [&](int64_t row, int c) { return Sums<1, float>{{x[row * sums.columns + c]}}; },
        [&](int, int c, const Sums<1, float>& of_channel) { mean[c] = of_channel[0] * inverse; });
  }
};

// var_c over the rows, and the running statistics after this batch. Runs after ChannelMeans.
struct ChannelVariances {
  static constexpr int kThreads = ColumnSums::kThreads;
  using Shared = ColumnSums::Shared<1>;

  ColumnSums sums = {};
  Source x = {};
  float inverse = 0, unbiased = 0;  // 1 / n, n / (n - 1)
  const float* mean = nullptr;
  float* variance = nullptr;
  const float *running_mean = nullptr, *running_variance = nullptr;
  float *next_mean = nullptr, *next_variance = nullptr;  // of the running statistics

  int blocks() const { return sums.blocks(); }
  bool operator==(const ChannelVariances&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    sums.Run<1>(
        block, shared,
        [&](int64_t row, int c) {
          const float distance = x[row * sums.columns + c] - mean[c];
          return Sums<1, float>{{distance * distance}};
        },
        [&](int, int c, const Sums<1, float>& of_channel) {
          constexpr float kMomentum = 0.1f;
          const float of_batch = of_channel[0] * inverse;
          variance[c] = of_batch;
          next_mean[c] = (1 - kMomentum) * running_mean[c] + kMomentum * mean[c];
          next_variance[c] =
              (1 - kMomentum) * running_variance[c] + kMomentum * (of_batch * unbiased);
        });
  }
};

// y = act(weight (x - mean) / sqrt(variance + 1e-5) + bias + skip)
struct BatchNormForward {
  static constexpr int kThreads = ChannelWork::kThreads;
  using Shared = NoShared;

  ChannelWork work = {};
  Source x = {}, skip = {};  // skip: may be absent
  const float *mean = nullptr, *variance = nullptr, *weight = nullptr, *bias = nullptr;
  Activation activation = Activation::kNone;
  Target y = {};

  int blocks() const { return work.blocks(); }
  bool operator==(const BatchNormForward&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    const bool skips = skip.f32 != nullptr || skip.bf16 != nullptr;
    work.Run(block, [&](int c, int64_t first, int64_t end, int64_t step) {
      const float scale = BatchNormScale(variance[c]) * weight[c], centre = mean[c];
      const float shift = bias[c];
      for (int64_t at = first; at < end; at += step) {
        const float normal = (x[at] - centre) * scale + shift;
        y.Set(at, Activate(activation, skips ? normal + skip[at] : normal));
      }
    });
  }
};

// dL/d(the sum before the activation). dy may be infinite where the slope is 0.
SHOAL_KERNEL float BeforeActivation(Activation activation, const Source& dy, const Source& y,
                                    int64_t at) {
  if (activation != Activation::kNone && ActivationSlope(activation, y[at]) == 0) return 0;
  return dy[at];
}

// Gradients of weight and bias from dL/dy: with dz of BeforeActivation,
//
//   dweight_c = sum dz (x - mean_c) / sqrt(variance_c + 1e-5),   dbias_c = sum dz
//
// The activation is ReLU or none. partials: 2 sums.PartialsSize().
struct BatchNormWeights {
  static constexpr int kThreads = ColumnSums::kThreads;
  using Shared = ColumnSums::Shared<2>;

  ColumnSums sums = {};
  Source x = {}, dy = {}, y = {};
  const float *mean = nullptr, *variance = nullptr;
  Activation activation = Activation::kNone;
  float *dweight = nullptr, *dbias = nullptr;

  int blocks() const { return sums.blocks(); }
  bool operator==(const BatchNormWeights&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    sums.Run<2>(
        block, shared,
        [&](int64_t row, int c) {
          const int64_t at = row * sums.columns + c;
          const float dz = BeforeActivation(activation, dy, y, at);
          return Sums<2, float>{{dz * (x[at] - mean[c]), dz}};
        },
        [&](int, int c, const Sums<2, float>& of_channel) {
          dweight[c] = of_channel[0] * BatchNormScale(variance[c]);
          dbias[c] = of_channel[1];
        });
  }
};

// dL/dx and dL/dskip of a pass by statistics of the batch, with xhat the normalised x:
//
//   dx = weight_c / sqrt(variance_c + 1e-5) (dz - dbias_c / n - xhat dweight_c / n),   dskip = dz
//
// Runs after BatchNormWeights. dx may be dy.
struct BatchNormBackward {
  static constexpr int kThreads = ChannelWork::kThreads;
  using Shared = NoShared;

  ChannelWork work = {};
  Source x = {}, dy = {}, y = {};
  float inverse = 0;  // 1 / n
  const float *mean = nullptr, *variance = nullptr, *weight = nullptr;
  const float *dweight = nullptr, *dbias = nullptr;
  Activation activation = Activation::kNone;
  Target dx = {}, dskip = {};  // dskip: may be absent

  int blocks() const { return work.blocks(); }
  bool operator==(const BatchNormBackward&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    work.Run(block, [&](int c, int64_t first, int64_t end, int64_t step) {
      const float scale = BatchNormScale(variance[c]), centre = mean[c];
      const float factor = scale * weight[c], shift = dbias[c] * inverse;
      const float slope = dweight[c] * inverse * scale;
      for (int64_t at = first; at < end; at += step) {
        const float dz = BeforeActivation(activation, dy, y, at);
        dx.Set(at, factor * (dz - shift - (x[at] - centre) * slope));
        dskip.Set(at, dz);
      }
    });
  }
};

// sum += addend, for maps of n numbers.
struct AddMap {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  int64_t n = 0;
  Source addend = {}, before = {};
  Target sum = {};  // the array of `before`

  int blocks() const { return BlocksForElements(n); }
  bool operator==(const AddMap&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForElements(block, block.index(), n, [&](int64_t i) { sum.Set(i, before[i] + addend[i]); });
  }
};

}  // namespace shoal::learner::kernels
