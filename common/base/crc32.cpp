// SPDX-License-Identifier: Apache-2.0
#include "common/base/crc32.h"

#include <libdeflate.h>

namespace shoal {

uint32_t Crc32(std::span<const uint8_t> bytes) {
  return libdeflate_crc32(0, bytes.data(), bytes.size());
}

}  // namespace shoal
