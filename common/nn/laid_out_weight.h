// SPDX-License-Identifier: Apache-2.0
// A layer's weights in the layout and the type in which one primitive reads them.
#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "common/nn/op.h"
#include "common/nn/parameter_set.h"

namespace shoal::nn {

// Layouts of the weights of one parameter set, shared by replicas. Each layout of each weight
// exists once. Each replica that reads a layout registers for it (Join). A large layout consists of
// pieces. The pieces are assigned to the registered replicas in rotation, so that the replicas
// divide the work. Replicas are built one after another and only read this object afterwards, so
// this object needs no lock.
class SharedLayouts {
 public:
  // `first_turn`: where the rotation begins; a different value for each set, so that the first
  // pieces of different sets are assigned to different ranks.
  explicit SharedLayouts(int first_turn) : next_turn_(first_turn) {}

  struct Layout {
    int64_t offset;  // offset of the parameter in its set
    dnnl::memory memory;
    int first_turn;          // position of the first piece in the rotation
    std::vector<int> ranks;  // registered ranks

    // Whether `rank` writes piece number `piece`.
    bool Writes(int rank, size_t piece) const {
      return ranks[(size_t(first_turn) + piece) % ranks.size()] == rank;
    }
  };
  // Registers `rank` and returns the layout `wanted` of the parameter at `offset`, in `pieces`
  // pieces. The first call makes the layout, which then lives as long as this object. Several
  // readers of one rank may use one layout; only the first of them writes. Sets `first_of_rank` to
  // true if this call is for the first reader of its rank, else to false.
  const Layout* Join(int64_t offset, const dnnl::memory::desc& wanted, int pieces, int rank,
                     bool* first_of_rank);

 private:
  std::deque<Layout> layouts_;
  int next_turn_;
};

// The weights of a layer in the layout of one primitive. If the set borrows its tensors, Refresh
// converts directly from the loaded tensors, f32 or bf16, to the type that the primitive reads.
// The result is the same as with an f32 copy in between, because widening bf16 to f32 is exact.
class LaidOutWeight {
 public:
  LaidOutWeight() = default;
  LaidOutWeight(const Parameter& weight, const dnnl::memory::desc& wanted,
                std::shared_ptr<Scratchpad> scratchpad);

  // The weights in the layout `wanted`. Borrowed weights are zeros before the first load.
  const dnnl::memory& memory() const { return from_f32_.memory(); }
  // Copies the parameter's current values. Each replica writes its share of the layouts. Therefore
  // all replicas must call Refresh and then pass a barrier (Replica::Meet) before any of them
  // reads.
  void Refresh();

 private:
  void RefreshBorrowed();
  void Share(SharedLayouts* layouts, const dnnl::memory::desc& wanted,
             const std::shared_ptr<Scratchpad>& scratchpad);

  Parameter weight_;
  dnnl::memory f32_;  // row-major, the memory of the parameter's values
  Relayout from_f32_;
  // Used with replicas only. pieces_: copies of the layout's pieces; empty unless this is the first
  // reader of its rank.
  const SharedLayouts::Layout* shared_ = nullptr;
  std::vector<Op> pieces_;
  // Used for borrowed weights only.
  dnnl::memory bf16_;
  Op from_bf16_;
  // Whether oneDNN can convert bf16 to this layout directly. This is possible on CPUs with AVX-512.
  bool reorders_bf16_ = false;
};

}  // namespace shoal::nn
