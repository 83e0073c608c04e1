// SPDX-License-Identifier: Apache-2.0
// A layer's weights in the layout and the type in which one primitive reads them.
#pragma once

#include <memory>
#include <vector>

#include "common/nn/op.h"
#include "common/nn/parameter_set.h"

namespace shoal::nn {

// Weights of a set that borrows are brought here straight from the tensors that were loaded, f32 or
// bf16, whatever the primitive reads: widening is exact, and so is rounding what has been widened.
class LaidOutWeight {
 public:
  LaidOutWeight() = default;
  LaidOutWeight(const Parameter& weight, const dnnl::memory::desc& wanted,
                std::shared_ptr<Scratchpad> scratchpad);

  // In `wanted`. Zeros of borrowed weights before the first load.
  const dnnl::memory& memory() const { return from_f32_.memory(); }
  // Takes over the parameter's present values.
  void Refresh();

 private:
  void RefreshBorrowed();

  Parameter weight_;
  dnnl::memory f32_;  // row-major, where the parameter's values lie
  Relayout from_f32_;
  // Of borrowed weights alone.
  dnnl::memory bf16_;
  Op from_bf16_;
  bool reorders_bf16_ = false;  // oneDNN does so on CPUs that have AVX-512
};

}  // namespace shoal::nn
