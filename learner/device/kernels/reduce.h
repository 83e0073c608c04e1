// SPDX-License-Identifier: Apache-2.0
// Sums and extremes over the threads of a block, in an order that depends on the number of threads
// alone.
#pragma once

#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/numbers.h"

namespace shoal::learner::kernels {

// N sums that are computed together.
template <int kCount, class T = double>
struct Sums {
  T values[kCount];

  SHOAL_KERNEL static Sums Zero() {
    Sums zero;
    for (int i = 0; i < kCount; ++i) zero.values[i] = 0;
    return zero;
  }
  SHOAL_KERNEL void Add(const Sums& other) {
    for (int i = 0; i < kCount; ++i) values[i] += other.values[i];
  }
  SHOAL_KERNEL T& operator[](int i) { return values[i]; }
  SHOAL_KERNEL T operator[](int i) const { return values[i]; }
};

// Smallest and largest number.
struct Extremes {
  float least, most;

  SHOAL_KERNEL void Add(const Extremes& other) {
    least = Least(least, other.least);
    most = Most(most, other.most);
  }
};

// Shared memory of a reduction. A phase writes the value of each thread to `of_thread`.
template <class T, int kThreads>
struct Reduction {
  static constexpr int kGroups = 32;
  static_assert(kThreads % kGroups == 0);

  T of_thread[kThreads];
  T result;
};

// Combines the values of all threads by T::Add: first groups of neighbouring threads, then the
// groups.
template <class Block, class T, int kThreads>
SHOAL_KERNEL T Combine(Block& block, Reduction<T, kThreads>& reduction) {
  constexpr int kGroups = Reduction<T, kThreads>::kGroups, kEach = kThreads / kGroups;
  block.Threads([&](int thread) {
    if (thread >= kGroups) return;
    T sum = reduction.of_thread[thread * kEach];
    for (int i = 1; i < kEach; ++i) sum.Add(reduction.of_thread[thread * kEach + i]);
    // Only this thread reads the values of its group.
    reduction.of_thread[thread * kEach] = sum;
  });
  block.Threads([&](int thread) {
    if (thread != 0) return;
    T sum = reduction.of_thread[0];
    for (int i = 1; i < kGroups; ++i) sum.Add(reduction.of_thread[i * kEach]);
    reduction.result = sum;
  });
  return reduction.result;
}

}  // namespace shoal::learner::kernels
