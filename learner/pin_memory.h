// SPDX-License-Identifier: Apache-2.0
// Pinned memory of batches. A device copies pinned host memory while the host continues; other
// memory goes through the driver's own buffers, which takes several times as long.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "learner/device/device.h"

namespace shoal::learner {

// Pins memory as long as the returned object exists, which must be destroyed before the memory.
// Returns null if the memory cannot be pinned. An empty function pins nothing: the learner computes
// on the CPU.
using PinMemory = std::function<std::shared_ptr<const void>(std::span<const uint8_t>)>;

// Pins memory for a device, which the result borrows. Logs one line if the device cannot pin
// memory. The end of a pin does not throw, also if the device is lost.
PinMemory PinOn(device::Device* device);

}  // namespace shoal::learner
