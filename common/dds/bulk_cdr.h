// SPDX-License-Identifier: Apache-2.0
// Parses bulk messages from serialised CDR in a receive buffer, without a copy of the payload.
// Every read is bounds-checked, because the bytes come from the network.
//
//   0x00 0x01 (CDR, little-endian) | 2 bytes options | body
//
// Each field of the body is aligned to its size, counted from the start of the body. Up to 3 bytes
// of padding may follow the body. docs/wire_format.md lists the bodies byte by byte.
#pragma once

#include <cstdint>
#include <span>

#include "common/wire/messages.h"

namespace shoal::dds {

// Version of a bulk message, which is its first byte. Messages of other versions are refused.
constexpr uint8_t BulkVersion(const TransitionChunk*) { return 1; }
constexpr uint8_t BulkVersion(const BatchPart*) { return 2; }    // 1: without unsampleable_steps
constexpr uint8_t BulkVersion(const WeightsPart*) { return 2; }  // 1: all weights in one message

// The functions return false if the bytes are truncated, inconsistent or of another version;
// `message` is then unspecified. The message's payload borrows `cdr`. Payloads are aligned to 8 if
// `cdr` starts 4 bytes before a multiple of 8, which is true for Cyclone's buffers.
bool ParseCdr(std::span<const uint8_t> cdr, TransitionChunk* message);
bool ParseCdr(std::span<const uint8_t> cdr, BatchPart* message);
bool ParseCdr(std::span<const uint8_t> cdr, WeightsPart* message);

}  // namespace shoal::dds
