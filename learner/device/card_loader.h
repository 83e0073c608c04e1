// SPDX-License-Identifier: Apache-2.0
// Finds libshoal-cuda.so and opens a card with it.
//
// The library is searched in the folders of LD_LIBRARY_PATH and of the system, beside the running
// program, in ../lib, and in ../lib/shoal. It stays loaded until the process ends.
//
// Errors: a card that cannot be used is an Error (kUsage) of one line. It names the missing part
// (the library, a library of CUDA, the driver, a card, memory) or, for a library of another build,
// both versions.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "learner/device/card_library.h"

namespace shoal::learner {

struct CardInfo {
  std::string name, driver;   // as in ShoalCardReply
  uint64_t memory_bytes = 0;  // of the card
};

// Checks whether a card can be used, without taking memory of it. Throws Error.
CardInfo ProbeCard();

struct OpenedCard {
  CardInfo info;
  ShoalCardReply reply{};

  // The use of the card; nullopt if it is unknown.
  std::optional<CardUse> Look() const;
};

// Opens the first card that CUDA shows to this process. The caller owns reply.device. Throws Error.
OpenedCard OpenCard();

}  // namespace shoal::learner
