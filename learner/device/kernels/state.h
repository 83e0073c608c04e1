// SPDX-License-Identifier: Apache-2.0
// State of updates in the device's memory, which kernels read and change.
#pragma once

#include <cstdint>

#include "learner/device/kernels/frame.h"

namespace shoal::learner::kernels {

// Whether an update has effects: 0 or 1 each.
struct Flags {
  int32_t finite, batch_finite, held;  // Engine::Outcome
  // Set by an update that is not finite. Later updates have no effect until the host clears it.
  int32_t halted;

  bool operator==(const Flags&) const = default;
};

// Whether steps and moves have an effect.
SHOAL_KERNEL bool Moves(const Flags& flags) { return flags.finite != 0 && flags.held == 0; }

// State of an optimiser.
struct AdamState {
  int64_t steps;  // that took effect
  int64_t taken;  // 1 if this update has taken a step, else 0
};

}  // namespace shoal::learner::kernels
