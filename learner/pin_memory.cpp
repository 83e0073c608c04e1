// SPDX-License-Identifier: Apache-2.0
#include "learner/pin_memory.h"

#include <utility>

#include "common/base/error.h"
#include "common/base/log.h"

namespace shoal::learner {
namespace {

void EndPin(device::Device* device, const uint8_t* memory) {
  try {
    device->UnregisterHost(memory);
  } catch (const Error&) {  // of a lost GPU, which pins nothing
  }
}

}  // namespace

PinMemory PinOn(device::Device* device) {
  // Copies of the function say it once together.
  const auto said = std::make_shared<bool>(false);
  return [device, said](std::span<const uint8_t> memory) -> std::shared_ptr<const void> {
    if (device->RegisterHost(memory.data(), int64_t(memory.size()))) {
      return {memory.data(), [device](const uint8_t* pinned) { EndPin(device, pinned); }};
    }
    if (!std::exchange(*said, true)) {
      log::Warning("{} cannot pin the memory of batches: copying them takes longer",
                   device->info().name);
    }
    return nullptr;
  };
}

}  // namespace shoal::learner
