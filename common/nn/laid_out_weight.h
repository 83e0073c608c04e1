// SPDX-License-Identifier: Apache-2.0
// A layer's weights in the layout and the type in which one primitive reads them.
#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "common/nn/op.h"
#include "common/nn/parameter_set.h"

namespace shoal::nn {

// The layouts of one set's weights, which replicas share. Each layout of each weight exists once. A
// replica that reads a layout joins the layout. A large layout consists of pieces; the joined
// replicas write the pieces in turn, so that they divide the work. Replicas are built one after
// another and only read this object later, so it needs no lock.
class SharedLayouts {
 public:
  // `first_turn`: the turn of the first piece. Different sets use different values, so that the
  // work begins at different ranks.
  explicit SharedLayouts(int first_turn) : next_turn_(first_turn) {}

  struct Layout {
    int64_t offset;  // offset of the parameter in its set
    dnnl::memory memory;
    int first_turn;          // turn of its first piece
    std::vector<int> ranks;  // ranks that joined

    // Whether `rank` writes this piece.
    bool Writes(int rank, size_t piece) const {
      return ranks[(size_t(first_turn) + piece) % ranks.size()] == rank;
    }
  };
  // Returns the layout `wanted` of the parameter at `offset`, in `pieces` pieces. The first call
  // makes the layout, which then lives as long as this object. Sets `first_of_rank` if this reader
  // is the first of its rank; only that reader writes.
  const Layout* Join(int64_t offset, const dnnl::memory::desc& wanted, int pieces, int rank,
                     bool* first_of_rank);

 private:
  std::deque<Layout> layouts_;
  int next_turn_;
};

// The weights of a layer in the layout of one primitive. If the set borrows its tensors, Refresh
// converts straight from the loaded tensors, f32 or bf16, to the type that the primitive reads.
// The result is the same as with an f32 copy in between, because widening bf16 to f32 is exact.
class LaidOutWeight {
 public:
  LaidOutWeight() = default;
  LaidOutWeight(const Parameter& weight, const dnnl::memory::desc& wanted,
                std::shared_ptr<Scratchpad> scratchpad);

  // The weights in the layout `wanted`. Borrowed weights are zeros before the first load.
  const dnnl::memory& memory() const { return from_f32_.memory(); }
  // Copies the parameter's current values. Each replica writes its share of the layouts, so all
  // replicas must refresh, and then meet before one of them reads.
  void Refresh();

 private:
  void RefreshBorrowed();
  void Share(SharedLayouts* layouts, const dnnl::memory::desc& wanted,
             const std::shared_ptr<Scratchpad>& scratchpad);

  Parameter weight_;
  dnnl::memory f32_;  // row-major, the memory of the parameter's values
  Relayout from_f32_;
  // Used with replicas only. pieces_: the pieces of the layout, if this is the first reader of its
  // rank.
  const SharedLayouts::Layout* shared_ = nullptr;
  std::vector<Op> pieces_;
  // Used for borrowed weights only.
  dnnl::memory bf16_;
  Op from_bf16_;
  bool reorders_bf16_ = false;  // oneDNN can on CPUs that have AVX-512
};

}  // namespace shoal::nn
