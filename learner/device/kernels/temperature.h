// SPDX-License-Identifier: Apache-2.0
// The temperature of SAC, its loss and its step (Eq. 8 of docs/algorithm.md).
#pragma once

#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/numbers.h"
#include "learner/device/kernels/optimiser.h"
#include "learner/device/kernels/state.h"

namespace shoal::learner::kernels {

// temperature = exp(log_temperature)
struct Temperature {
  static constexpr int kThreads = 32;
  using Shared = NoShared;

  const float* log_temperature = nullptr;
  double* temperature = nullptr;

  int blocks() const { return 1; }
  bool operator==(const Temperature&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    block.Threads([&](int thread) {
      if (thread == 0) *temperature = std::exp(*log_temperature);
    });
  }
};

// Eq. 8: L = temperature (entropy - target_entropy), in f32.
struct TemperatureLoss {
  static constexpr int kThreads = 32;
  using Shared = NoShared;

  const double *temperature = nullptr, *entropy = nullptr;
  float target_entropy = 0;
  double* loss = nullptr;

  int blocks() const { return 1; }
  bool operator==(const TemperatureLoss&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    block.Threads([&](int thread) {
      if (thread == 0) *loss = float(*temperature) * (float(*entropy) - target_entropy);
    });
  }
};

// If the flag is set: one step of the log temperature, the first number of the set, with the
// gradient `loss`. Afterwards it is at least `least`, a log temperature.
struct StepTemperature {
  static constexpr int kThreads = 32;
  using Shared = NoShared;

  AdamSet set = {};
  AdamOptions options = {};  // without a limit of the norm
  const double* loss = nullptr;
  float least = 0;
  AdamState* state = nullptr;
  const Flags* flags = nullptr;

  int blocks() const { return 1; }
  bool operator==(const StepTemperature&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    block.Threads([&](int thread) {
      if (!Moves(*flags)) return;
      // An undo restores the whole set.
      ForAll<kThreads>(thread, set.size, [&](int64_t i) { KeepNumber(set, i); });
      if (thread != 0) return;
      StepNumber(set, 0, float(*loss), options.SizeOf(state->steps + 1, 0));
      set.Set(0, Most(set.value[0], least));
      ++state->steps;
      state->taken = 1;
    });
  }
};

}  // namespace shoal::learner::kernels
