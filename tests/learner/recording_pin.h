// SPDX-License-Identifier: Apache-2.0
// A PinMemory that records what it is given, and checks that the memory outlives its pin.
#pragma once

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "learner/pin_memory.h"

namespace shoal::learner {

// Not movable: the pins borrow this object.
struct RecordingPin {
  RecordingPin() = default;
  RecordingPin(const RecordingPin&) = delete;
  RecordingPin& operator=(const RecordingPin&) = delete;

  PinMemory Function() {
    return [this](std::span<const uint8_t> memory) -> std::shared_ptr<const void> {
      given.push_back(memory);
      ++pinned;
      return {memory.data(), [this, memory](const void*) {
                --pinned;
                EXPECT_TRUE(IsMapped(memory)) << "the memory ended before its pin";
              }};
    };
  }

  std::vector<std::span<const uint8_t>> given;  // all that was ever pinned
  int pinned = 0;                               // now

 private:
  static bool IsMapped(std::span<const uint8_t> memory) {
    const auto page = static_cast<uintptr_t>(sysconf(_SC_PAGESIZE));
    const uintptr_t in_page = reinterpret_cast<uintptr_t>(memory.data()) % page;
    unsigned char resident;
    return mincore(const_cast<uint8_t*>(memory.data()) - in_page, 1, &resident) == 0;
  }
};

}  // namespace shoal::learner
