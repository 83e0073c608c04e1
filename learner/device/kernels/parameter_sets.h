// SPDX-License-Identifier: Apache-2.0
// Passes over several parameter sets in one launch: moves of targets and averages (Eq. 9 and 12 of
// docs/algorithm.md), and copies in bf16 for products.
#pragma once

#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/numbers.h"
#include "learner/device/kernels/state.h"

namespace shoal::learner::kernels {

constexpr int kMostSets = 8;  // parameter sets of one launch

// Finds the set and the block within it. set.size: its number of floats.
template <class Set>
SHOAL_KERNEL const Set& SetOfBlock(const Set* sets, int* block) {
  for (; *block >= BlocksForElements(sets->size); ++sets) *block -= BlocksForElements(sets->size);
  return *sets;
}

template <class Set>
int BlocksForSets(const Set* sets, int count) {
  int blocks = 0;
  for (int i = 0; i < count; ++i) blocks += BlocksForElements(sets[i].size);
  return blocks;
}

// If the flag is set: target += tau (online - target), for all targets of a move.
struct MoveTowards {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  struct Set {
    int64_t size = 0, trained = 0;  // numbers beyond `trained` are copied: statistics
    const float* online = nullptr;
    float* target = nullptr;
    uint16_t* rounded = nullptr;  // the target in bf16; null: none
    bool operator==(const Set&) const = default;
  };
  int set_count = 0;
  Set sets[kMostSets] = {};
  float tau = 0;
  const Flags* flags = nullptr;

  int blocks() const { return BlocksForSets(sets, set_count); }
  bool operator==(const MoveTowards&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    if (!Moves(*flags)) return;
    int index = block.index();
    const Set& set = SetOfBlock(sets, &index);
    ForElements(block, index, set.size, [&](int64_t i) {
      const float target = set.target[i], online = set.online[i];
      const float moved = i < set.trained ? target + tau * (online - target) : online;
      set.target[i] = moved;
      if (set.rounded != nullptr) set.rounded[i] = ToBf16(moved);
    });
  }
};

// Rounds arrays to bf16.
struct RoundToBf16 {
  static constexpr int kThreads = kElementThreads;
  using Shared = NoShared;

  struct Set {
    int64_t size = 0;
    const float* from = nullptr;
    uint16_t* to = nullptr;
    bool operator==(const Set&) const = default;
  };
  int set_count = 0;
  Set sets[kMostSets] = {};

  int blocks() const { return BlocksForSets(sets, set_count); }
  bool operator==(const RoundToBf16&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    int index = block.index();
    const Set& set = SetOfBlock(sets, &index);
    ForElements(block, index, set.size, [&](int64_t i) { set.to[i] = ToBf16(set.from[i]); });
  }
};

}  // namespace shoal::learner::kernels
