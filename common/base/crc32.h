// SPDX-License-Identifier: Apache-2.0
// CRC-32 (IEEE 802.3, as in zlib) of bytes, for weights in messages and for files.
#pragma once

#include <cstdint>
#include <span>

namespace shoal {

uint32_t Crc32(std::span<const uint8_t> bytes);

}  // namespace shoal
