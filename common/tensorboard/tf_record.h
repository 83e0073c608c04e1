// SPDX-License-Identifier: Apache-2.0
// TFRecord framing of one payload:
//
//   u64 LE length | u32 LE masked CRC-32C of the length | payload
//   | u32 LE masked CRC-32C of the payload
//
// Source: tensorflow/core/lib/io/record_writer.h.
#pragma once

#include <string>
#include <string_view>

namespace shoal::tensorboard {

// Appends the framed payload to `out`.
void AppendTfRecord(std::string_view payload, std::string* out);

}  // namespace shoal::tensorboard
