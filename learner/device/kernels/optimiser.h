// SPDX-License-Identifier: Apache-2.0
// Steps of an optimiser, over all of its parameters in one launch, and their undo. Formulas:
// common/nn/adam.h.
//
// A step changes parameters and moments in place and stores their former values, with which
// EndUpdate restores them. It also writes the parameters in bf16 for products.
#pragma once

#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/numbers.h"
#include "learner/device/kernels/parameter_sets.h"
#include "learner/device/kernels/reduce.h"
#include "learner/device/kernels/state.h"

namespace shoal::learner::kernels {

// The sum of squares of all gradients of an optimiser.
struct SumOfSquares {
  static constexpr int kThreads = kElementThreads;
  struct Shared {
    Reduction<Sums<1>, kThreads> sum;
  };

  struct Set {
    const float* values = nullptr;
    int64_t size = 0;
    bool operator==(const Set&) const = default;
  };
  int set_count = 0;
  Set sets[kMostSets] = {};
  double* partials = nullptr;   // one for each block
  int32_t* finished = nullptr;  // counter, 0
  double* squares = nullptr;

  int blocks() const { return BlocksForSets(sets, set_count); }
  bool operator==(const SumOfSquares&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    int index = block.index();
    const Set& set = SetOfBlock(sets, &index);
    const int64_t first = int64_t(index) * kElementsOfBlock;
    const int64_t count = Least(set.size - first, int64_t(kElementsOfBlock));
    const double own = SumOver(block, shared, count, [&](int64_t i) {
      const double value = set.values[first + i];
      return value * value;
    });
    block.Threads([&](int thread) {
      if (thread == 0) partials[block.index()] = own;
    });
    if (!block.FinishesLast(finished, block.count())) return;
    const double total =
        SumOver(block, shared, block.count(), [&](int64_t i) { return partials[i]; });
    block.Threads([&](int thread) {
      if (thread == 0) *squares = total;
    });
  }

 private:
  template <class Block, class Term>
  SHOAL_KERNEL double SumOver(Block& block, Shared& shared, int64_t n, const Term& term) const {
    block.Threads([&](int thread) {
      auto sum = Sums<1>::Zero();
      ForAll<kThreads>(thread, n, [&](int64_t i) { sum[0] += term(i); });
      shared.sum.of_thread[thread] = sum;
    });
    return Combine(block, shared.sum)[0];
  }
};

// A parameter set, its moments, and their values before the last step. Moments have `trained`
// floats, values `size`: running statistics follow the trained parameters. A step gives statistics
// the values that the latest forward pass has measured.
struct AdamSet {
  int64_t size = 0, trained = 0;
  float *value = nullptr, *m = nullptr, *v = nullptr;
  float *former_value = nullptr, *former_m = nullptr, *former_v = nullptr;
  uint16_t* rounded = nullptr;             // the values in bf16; null: none
  const float* next_statistics = nullptr;  // (size - trained)

  bool operator==(const AdamSet&) const = default;
  SHOAL_KERNEL void Set(int64_t i, float to) const {
    value[i] = to;
    if (rounded != nullptr) rounded[i] = ToBf16(to);
  }
};

// Rates of one step.
struct StepSize {
  float rate;        // rate / (1 - b1^t)
  float root_scale;  // 1 / sqrt(1 - b2^t)
  float epsilon;
  float clip;  // factor of the gradients
};

struct AdamOptions {
  double rate = 0, epsilon = 0;
  double max_norm = 0;                  // 0: no limit
  const double* rate_factor = nullptr;  // null: 1

  bool operator==(const AdamOptions&) const = default;
  // The step with which the optimiser's count becomes `steps`.
  SHOAL_KERNEL StepSize SizeOf(int64_t steps, double squares) const {
    const double factor = rate_factor != nullptr ? *rate_factor : 1.0;
    const auto t = double(steps);
    const double clip = max_norm > 0 ? max_norm / (std::sqrt(squares) + 1e-6) : 1.0;
    return {float(rate * factor / (1 - std::pow(0.9, t))),
            float(1 / std::sqrt(1 - std::pow(0.999, t))), float(epsilon),
            clip < 1 ? float(clip) : 1.f};
  }
};

// Stores number i for an undo.
SHOAL_KERNEL void KeepNumber(const AdamSet& set, int64_t i) {
  set.former_m[i] = set.m[i];
  set.former_v[i] = set.v[i];
  set.former_value[i] = set.value[i];
}

// One step of number i.
SHOAL_KERNEL void StepNumber(const AdamSet& set, int64_t i, float gradient, const StepSize& size) {
  constexpr float kB1 = 0.9f, kC1 = float(1 - 0.9), kB2 = 0.999f, kC2 = float(1 - 0.999);
  const float g = gradient * size.clip, m = set.m[i], v = set.v[i], w = set.value[i];
  KeepNumber(set, i);
  const float next_m = kB1 * m + kC1 * g;
  const float next_v = kB2 * v + kC2 * g * g;
  set.m[i] = next_m;
  set.v[i] = next_v;
  set.Set(i, w - size.rate * next_m / (std::sqrt(next_v) * size.root_scale + size.epsilon));
}

// The step of number i, a statistic.
SHOAL_KERNEL void StepStatistic(const AdamSet& set, int64_t i) {
  set.former_value[i] = set.value[i];
  set.Set(i, set.next_statistics[i - set.trained]);
}

// Clears the flag if the squares would overflow in Adam's second moment, unless the steps are held.
// If the flag is set: makes one step of all sets.
struct Adam {
  static constexpr int kThreads = kElementThreads;
  struct Shared {
    StepSize size;
    int32_t moves, overflows;
  };

  int set_count = 0;
  AdamSet sets[kMostSets] = {};
  const float* gradients[kMostSets] = {};
  AdamOptions options = {};
  const double* squares = nullptr;  // of the gradients
  AdamState* state = nullptr;
  Flags* flags = nullptr;
  int32_t* finished = nullptr;  // counter, 0

  int blocks() const { return BlocksForSets(sets, set_count); }
  bool operator==(const Adam&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared& shared) const {
    block.Threads([&](int thread) {
      if (thread != 0) return;
      shared.overflows = *squares < 3.4028234663852886e38 ? 0 : 1;
      shared.moves = Moves(*flags) && shared.overflows == 0 ? 1 : 0;
      shared.size = options.SizeOf(state->steps + 1, *squares);
    });
    if (shared.moves != 0) {
      int index = block.index();
      const AdamSet& set = SetOfBlock(sets, &index);
      const float* gradient = gradients[&set - sets];
      ForElements(block, index, set.size, [&](int64_t i) {
        if (i >= set.trained) return StepStatistic(set, i);
        StepNumber(set, i, gradient[i], shared.size);
      });
    }
    // All blocks read the state and the flag, so only the last of them changes both.
    if (!block.FinishesLast(finished, block.count())) return;
    block.Threads([&](int thread) {
      if (thread != 0) return;
      if (shared.overflows != 0 && flags->held == 0) flags->finite = 0;
      if (shared.moves == 0) return;
      ++state->steps;
      state->taken = 1;
    });
  }
};

// Ends an update. If the flag is cleared: undoes the steps that optimisers have made in this
// update, and halts later updates.
struct EndUpdate {
  static constexpr int kThreads = kElementThreads;
  static constexpr int kMostUndone = 12;
  using Shared = NoShared;

  int set_count = 0;
  AdamSet sets[kMostUndone] = {};
  AdamState* states[kMostUndone] = {};  // of the optimiser of each set
  bool counts[kMostUndone] = {};        // true for one set of each optimiser
  Flags* flags = nullptr;
  int32_t* finished = nullptr;  // counter, 0

  int blocks() const { return Most(1, BlocksForSets(sets, set_count)); }
  bool operator==(const EndUpdate&) const = default;

  template <class Block>
  SHOAL_KERNEL void Run(Block& block, Shared&) const {
    if (flags->finite != 0) return;
    if (set_count > 0) Undo(block);
    // All blocks read what the optimisers have done, so only the last of them changes it.
    if (!block.FinishesLast(finished, block.count())) return;
    block.Threads([&](int thread) {
      if (thread == 0) flags->halted = 1;
      if (thread >= set_count || !counts[thread] || states[thread]->taken == 0) return;
      --states[thread]->steps;
      states[thread]->taken = 0;
    });
  }

 private:
  template <class Block>
  SHOAL_KERNEL void Undo(Block& block) const {
    int index = block.index();
    const AdamSet& set = SetOfBlock(sets, &index);
    if (states[&set - sets]->taken == 0) return;
    ForElements(block, index, set.size, [&](int64_t i) {
      set.Set(i, set.former_value[i]);
      if (i >= set.trained) return;
      set.m[i] = set.former_m[i];
      set.v[i] = set.former_v[i];
    });
  }
};

}  // namespace shoal::learner::kernels
