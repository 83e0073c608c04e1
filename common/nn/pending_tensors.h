// SPDX-License-Identifier: Apache-2.0
// Tensors of which some are on their way from the memory of an engine to the host, so that the
// engine computes while they are copied.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "common/nn/safetensors.h"

namespace shoal::nn {

// Must not outlive the engine and the parameters. Only one thread may use an object.
class PendingTensors {
 public:
  // Waits for values and writes them as tensors.
  using Land = std::function<void(TensorMap*)>;

  PendingTensors() = default;
  // All tensors have arrived.
  explicit PendingTensors(TensorMap arrived) : arrived_(std::move(arrived)) {}

  // The tensors that have arrived.
  TensorMap* arrived() { return &arrived_; }
  // Adds tensors that are on their way. Take calls `land` once and destroys it.
  void Add(Land land) { lands_.push_back(std::move(land)); }

  // Waits for the tensors that are on their way and returns all tensors. Call it once.
  TensorMap Take() {
    for (const Land& land : std::exchange(lands_, {})) land(&arrived_);
    return std::move(arrived_);
  }

 private:
  TensorMap arrived_;
  std::vector<Land> lands_;
};

}  // namespace shoal::nn
