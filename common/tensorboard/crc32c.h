// SPDX-License-Identifier: Apache-2.0
// CRC-32C (Castagnoli, polynomial 0x1EDC6F41 reflected): the checksum of TFRecord files.
#pragma once

#include <cstdint>
#include <string_view>

namespace shoal::tensorboard {

// Example: Crc32c("123456789") = 0xe3069283.
uint32_t Crc32c(std::string_view bytes);

// Converts a checksum to the form that TFRecord files store: rotated and with an offset. The
// reason: a CRC of data that itself contains plain CRCs detects errors less well.
constexpr uint32_t MaskCrc(uint32_t crc) { return ((crc >> 15) | (crc << 17)) + 0xa282ead8u; }

}  // namespace shoal::tensorboard
