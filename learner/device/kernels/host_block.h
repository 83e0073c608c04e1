// SPDX-License-Identifier: Apache-2.0
// Runs kernels on the host: block by block, the threads of each phase in turn. Shared memory and
// private values hold invalid numbers before a block begins, as a card does not initialise them.
#pragma once

#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/numbers.h"

namespace shoal::learner::kernels {

// Order of the blocks, and of the threads of a phase. A kernel that breaks the rules of frame.h has
// different results in different orders.
enum class HostOrder { kForward, kBackward };

// One block of a launch on the host.
template <int kThreads>
class HostBlock {
 public:
  static constexpr int kWarps = kThreads / kWarpThreads;

  HostBlock(int index, int count, HostOrder order) : index_(index), count_(count), order_(order) {}

  int index() const { return index_; }
  int count() const { return count_; }

  template <class Body>
  void Threads(const Body& body) const {
    for (int i = 0; i < kThreads; ++i) {
      body(order_ == HostOrder::kForward ? i : kThreads - 1 - i);
    }
  }

  // kCount numbers of type T, which are invalid before they are written.
  template <class T, int kCount>
  class Values {
   public:
    explicit Values(const HostBlock&) : values_(kCount) {
      std::memset(static_cast<void*>(values_.data()), 0xff, values_.size() * sizeof(T));
    }
    T& operator()(int i) { return values_[size_t(i)]; }

   private:
    std::vector<T> values_;
  };
  // One T for each thread.
  template <class T>
  using Private = Values<T, kThreads>;

  template <class Body>
  void Warps(const Body& body) const {
    static_assert(kThreads % kWarpThreads == 0);
    for (int i = 0; i < kWarps; ++i) body(order_ == HostOrder::kForward ? i : kWarps - 1 - i);
  }

  struct Rows {
    float numbers[16][16];
  };
  template <class RowOf>
  static Rows ReadRows(const RowOf& row_of) {
    Rows rows;
    for (int k = 0; k < 16; ++k) {
      const uint16_t* row = row_of(k);
      for (int m = 0; m < 16; ++m) rows.numbers[k][m] = FromBf16(row[m]);
    }
    return rows;
  }

  template <class HalfOf>
  static Rows ReadColumns(const HalfOf& half_of) {
    Rows rows;
    for (int m = 0; m < 16; ++m) {
      for (int k = 0; k < 16; ++k) rows.numbers[k][m] = FromBf16(half_of(m, k / 8)[k % 8]);
    }
    return rows;
  }

  class Tile {
   public:
    void Clear() { std::memset(sums_, 0, sizeof(sums_)); }
    void AddProduct(const Rows& a, const Rows& b) {
      for (int k = 0; k < 16; ++k) {
        for (int m = 0; m < 16; ++m) {
          for (int n = 0; n < 16; ++n) sums_[m][n] += a.numbers[k][m] * b.numbers[k][n];
        }
      }
    }
    template <class Body>
    void ForEachPair(const Body& body) const {
      for (int m = 0; m < 16; ++m) {
        for (int n = 0; n < 16; n += 2) body(m, n, sums_[m][n], sums_[m][n + 1]);
      }
    }

   private:
    float sums_[16][16];
  };

  template <class T>
  using PerWarp = Values<T, kWarps>;

  // Returns true in the last of `blocks` blocks that call this function with the same counter. The
  // counter is 0 before and afterwards. The last block sees what the others wrote.
  bool FinishesLast(int32_t* counter, int blocks) const {
    if (++*counter < blocks) return false;
    *counter = 0;
    return true;
  }

 private:
  const int index_, count_;
  const HostOrder order_;
};

template <class Kernel>
void RunOnHost(const Kernel& kernel, HostOrder order) {
  using Shared = typename Kernel::Shared;
  const auto bytes = std::make_unique<std::byte[]>(sizeof(Shared) + alignof(Shared));
  void* address = bytes.get();
  size_t space = sizeof(Shared) + alignof(Shared);
  auto* shared = static_cast<Shared*>(std::align(alignof(Shared), sizeof(Shared), address, space));
  const int blocks = kernel.blocks();
  for (int i = 0; i < blocks; ++i) {
    std::memset(static_cast<void*>(shared), 0xff, sizeof(Shared));
    const int index = order == HostOrder::kForward ? i : blocks - 1 - i;
    HostBlock<Kernel::kThreads> block(index, blocks, order);
    kernel.Run(block, *shared);
  }
}

}  // namespace shoal::learner::kernels
