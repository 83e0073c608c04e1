// SPDX-License-Identifier: Apache-2.0
// Interface between the learner and libshoal-cuda.so, the only object that links CUDA. The learner
// opens the library with dlopen and calls its one exported function. A build without CUDA has no
// such library.
//
// The structs have no constructors, so that a library of another build can be recognised by its
// version before anything else of it is used. Texts end with '\0'.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "common/base/build_info.h"

namespace shoal::learner {

namespace device {
class Device;
}

inline constexpr char kCardLibrary[] = "libshoal-cuda.so";
inline constexpr char kOpenCardFunction[] = "ShoalOpenCard";

// Version that learner and library must share: both sides call virtual functions of each other.
inline std::string CardLibraryVersion() {
  return std::string(BuildVersion()) + " " + BuildCommit();
}

// Use of a card's memory and processors.
struct CardUse {
  uint64_t memory_bytes = 0;       // used by all processes
  uint64_t memory_size_bytes = 0;  // of the card
  double busy = -1;                // share of the last second with a running kernel; -1: unknown
};

extern "C" {

struct ShoalCardRequest {
  const char* version;  // CardLibraryVersion() of the learner
  int open;             // 0: only checks whether a card can be used, and fills name and driver
};

struct ShoalCardReply {
  char version[128];      // of the library
  char refusal[512];      // one line: why no card can be used; empty if one can
  char name[256];         // "NVIDIA H100 80GB HBM3"
  char driver[64];        // "580.159.04"
  uint64_t memory_bytes;  // of the card
  // The opened card, which the caller deletes; null unless `open` and not refused.
  shoal::learner::device::Device* device;
  // Reads the use of the opened card. Returns 0 if it is unknown. Any thread.
  int (*look)(shoal::learner::CardUse* use);
};

// Writes the reply, which the caller has filled with zeros. Throws nothing.
using ShoalOpenCardFunction = void(const ShoalCardRequest* request, ShoalCardReply* reply);

}  // extern "C"

}  // namespace shoal::learner
