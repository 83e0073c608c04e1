// SPDX-License-Identifier: Apache-2.0
// Moments of vectors, and vectors standardised by them (learner/engine/moments.h).
// Dimensions: B rows, V vector size.
#pragma once

#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/numbers.h"
#include "learner/device/kernels/reduce.h"
#include "learner/device/kernels/state.h"

namespace shoal::learner::kernels {

// y = clip((x - mean) / sqrt(variance + 1e-8), -10, 10) with the mean and variance of `moments`
// (learner/engine/moments.h); variances below the floor become the floor. x, y (B, V).
struct Standardise {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  int rows = 0, width = 0;
  const float* x = nullptr;
  const double* moments = nullptr;  // (1 + 2V)
  float variance_floor = 0;
  float* y = nullptr;

  int blocks() const { return BlocksForElements(int64_t{rows} * width); }
  bool operator==(const Standardise&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    ForElements(block, block.index(), int64_t(rows) * width, [&](int64_t at) {
      const int j = int(at) % width;  // a division of 64 bits would take registers
      const auto mean = float(moments[1 + j]);
      const double count = moments[0];
      const float variance =
          Most(count > 0 ? float(moments[1 + width + j] / count) : 1.f, variance_floor);
      y[at] = Clamp((x[at] - mean) * (1 / std::sqrt(variance + 1e-8f)), -10.f, 10.f);
    });
  }
};

// If the flag is set: adds vectors (N, V) to the moments. One block for each column.
struct AddToMoments {
  static constexpr int kThreads = 128;
  struct Shared {
    Reduction<Sums<1>, kThreads> sum;
  };

  int rows = 0, width = 0;  // N, V
  const float* vectors = nullptr;
  double* moments = nullptr;
  const Flags* flags = nullptr;  // null: outside of an update
  int32_t* finished = nullptr;   // counter, 0

  int blocks() const { return rows > 0 ? width : 0; }
  bool operator==(const AddToMoments&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    if (flags != nullptr && !Moves(*flags)) return;
    const int j = block.index();
    const double mean = SumOver(block, shared, [&](double x) { return x; }) / rows;
    const double squares =
        SumOver(block, shared, [&](double x) { return (x - mean) * (x - mean); });
    block.Threads([&](int thread) {
      if (thread != 0) return;
      const double count = moments[0], total = count + rows, apart = mean - moments[1 + j];
      moments[1 + width + j] += squares + apart * apart * count * rows / total;
      moments[1 + j] += apart * rows / total;
    });
    // All blocks read the count, so only the last of them changes it.
    if (!block.FinishesLast(finished, block.count())) return;
    block.Threads([&](int thread) {
      if (thread == 0) moments[0] += rows;
    });
  }

 private:
  template <class Block, class Term>
  SHOAL_KERNEL double SumOver(Block& block, Shared& shared, const Term& term) const {
    block.Threads([&](int thread) {
      auto sum = Sums<1>::Zero();
      ForAll<kThreads>(thread, rows, [&](int64_t i) {
        sum[0] += term(double(vectors[i * width + block.index()]));
      });
      shared.sum.of_thread[thread] = sum;
    });
    return Combine(block, shared.sum)[0];
  }
};

}  // namespace shoal::learner::kernels
