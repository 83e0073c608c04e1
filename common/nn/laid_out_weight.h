// SPDX-License-Identifier: Apache-2.0
// A layer's weights in the layout and the type in which one primitive reads them.
#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "common/nn/op.h"
#include "common/nn/parameter_set.h"

namespace shoal::nn {

// The layouts of one set's weights that replicas share: each layout of each weight once. A replica
// that reads a layout joins it. Large layouts consist of pieces, and those who joined write them in
// turn, so that replicas divide the work. Replicas are built one after another, and later only read
// this: it needs no lock.
class SharedLayouts {
 public:
  // `first_turn`: of the first piece. Sets of different numbers begin with different ranks.
  explicit SharedLayouts(int first_turn) : next_turn_(first_turn) {}

  struct Layout {
    int64_t offset;  // of the parameter in its set
    dnnl::memory memory;
    int first_turn;          // of its first piece
    std::vector<int> ranks;  // that joined

    // Whether `rank` is the one to write this piece.
    bool Writes(int rank, size_t piece) const {
      return ranks[(size_t(first_turn) + piece) % ranks.size()] == rank;
    }
  };
  // The layout `wanted` of the parameter at `offset`, which has so many pieces. Made by the first
  // to join; stays. `first_of_rank`: this is the rank's first reader, the one that writes.
  const Layout* Join(int64_t offset, const dnnl::memory::desc& wanted, int pieces, int rank,
                     bool* first_of_rank);

 private:
  std::deque<Layout> layouts_;
  int next_turn_;
};

// Weights of a set that borrows are brought here straight from the tensors that were loaded, f32 or
// bf16, whatever the primitive reads: widening is exact, and so is rounding what has been widened.
class LaidOutWeight {
 public:
  LaidOutWeight() = default;
  LaidOutWeight(const Parameter& weight, const dnnl::memory::desc& wanted,
                std::shared_ptr<Scratchpad> scratchpad);

  // In `wanted`. Zeros of borrowed weights before the first load.
  const dnnl::memory& memory() const { return from_f32_.memory(); }
  // Takes over the parameter's present values. Of replicas, each writes its share of the layouts:
  // all of them refresh, and meet before anyone reads.
  void Refresh();

 private:
  void RefreshBorrowed();
  void Share(SharedLayouts* layouts, const dnnl::memory::desc& wanted,
             const std::shared_ptr<Scratchpad>& scratchpad);

  Parameter weight_;
  dnnl::memory f32_;  // row-major, where the parameter's values lie
  Relayout from_f32_;
  // Replicas: the pieces of the layout, if this is the first reader of its rank.
  const SharedLayouts::Layout* shared_ = nullptr;
  std::vector<Op> pieces_;
  // Used for borrowed weights only.
  dnnl::memory bf16_;
  Op from_bf16_;
  bool reorders_bf16_ = false;  // oneDNN does so on CPUs that have AVX-512
};

}  // namespace shoal::nn
