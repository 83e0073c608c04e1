// SPDX-License-Identifier: Apache-2.0
// Pinned memory of batches. A device copies pinned host memory while the host continues; other
// memory goes through the driver's own buffers, which takes several times as long.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

namespace shoal::learner {

// Pins memory as long as the returned object exists, which must be destroyed before the memory.
// Returns null if the memory cannot be pinned. An empty function pins nothing: the learner computes
// on the CPU.
using PinMemory = std::function<std::shared_ptr<const void>(std::span<const uint8_t>)>;

}  // namespace shoal::learner
