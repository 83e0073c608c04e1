// SPDX-License-Identifier: Apache-2.0
// The flag that says whether all numbers of an update are finite (learner/engine/engine.h).
// EndUpdate (optimiser.h) reads it last.
#pragma once

#include <cmath>

#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/state.h"

namespace shoal::learner::kernels {

// Begins an update: sets the flag if the batch is finite and updates are not halted, and forgets
// that optimisers have made steps.
struct BeginUpdate {
  static constexpr int kThreads = 32;
  static constexpr int kMostOptimisers = 8;
  using Shared = NoShared;

  const int32_t* batch_finite = nullptr;  // 0 or 1
  Flags* flags = nullptr;
  int optimiser_count = 0;
  AdamState* optimisers[kMostOptimisers] = {};

  int blocks() const { return 1; }
  bool operator==(const BeginUpdate&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    block.Threads([&](int thread) {
      if (thread == 0) {
        flags->finite = *batch_finite != 0 && flags->halted == 0 ? 1 : 0;
        flags->batch_finite = *batch_finite;
        flags->held = 0;
      }
      if (thread < optimiser_count) optimisers[thread]->taken = 0;
    });
  }
};

// Clears the flag if one of the numbers is not finite, unless the steps are held.
struct RequireFinite {
  static constexpr int kThreads = 32;
  static constexpr int kMostNumbers = 8;
  using Shared = NoShared;

  int count = 0;
  const double* numbers[kMostNumbers] = {};
  Flags* flags = nullptr;

  int blocks() const { return 1; }
  bool operator==(const RequireFinite&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    block.Threads([&](int thread) {
      if (thread != 0 || flags->held != 0) return;
      for (int i = 0; i < count; ++i) {
        if (!std::isfinite(*numbers[i])) flags->finite = 0;
      }
    });
  }
};

// Holds the following steps and moves of this update if number > limit.
struct HoldSteps {
  static constexpr int kThreads = 32;
  using Shared = NoShared;

  const double* number = nullptr;
  double limit = 0;
  Flags* flags = nullptr;

  int blocks() const { return 1; }
  bool operator==(const HoldSteps&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    block.Threads([&](int thread) {
      if (thread == 0 && *number > limit) flags->held = 1;
    });
  }
};

}  // namespace shoal::learner::kernels
