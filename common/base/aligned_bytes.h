// SPDX-License-Identifier: Apache-2.0
// Memory for a batch's arrays, which begin at multiples of 64 bytes (common/wire/batch_schema.h).
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>

#include "common/base/error.h"

namespace shoal {

// Owns its bytes, whose initial values are undefined. Move-only.
class AlignedBytes {
 public:
  static constexpr uint64_t kAlignment = 64;

  AlignedBytes() = default;  // no bytes
  // Throws Error if the memory cannot be allocated.
  explicit AlignedBytes(uint64_t bytes)
      // aligned_alloc takes whole multiples of the alignment.
      : bytes_(static_cast<uint8_t*>(
            std::aligned_alloc(kAlignment, (bytes + kAlignment - 1) / kAlignment * kAlignment))) {
    if (bytes_ == nullptr) throw RuntimeError("no memory for {} bytes", bytes);
  }

  uint8_t* data() const { return bytes_.get(); }

 private:
  struct Free {
    void operator()(uint8_t* bytes) const { std::free(bytes); }
  };

  std::unique_ptr<uint8_t[], Free> bytes_;
};

}  // namespace shoal
