// SPDX-License-Identifier: Apache-2.0
// Parses the bulk messages from serialised CDR in a receive buffer, without copying the payload.
// Everything is bounds-checked: the bytes come from the network.
//
//   0x00 0x01 (CDR, little-endian) | 2 bytes options | body
//
// Fields of the body are aligned to their size, counted from its start; up to 3 bytes of padding
// may follow. docs/wire_format.md lists the bodies byte by byte.
#pragma once

#include <cstdint>
#include <span>

#include "common/wire/messages.h"

namespace shoal::dds {

// First byte of a bulk message; others are refused.
constexpr uint8_t BulkVersion(const TransitionChunk*) { return 1; }
constexpr uint8_t BulkVersion(const BatchPart*) { return 2; }    // 1 had no unsampleable_steps
constexpr uint8_t BulkVersion(const WeightsPart*) { return 2; }  // 1 sent weights whole

// Returns false when the bytes are truncated, of another version or inconsistent; `message` is then
// unspecified. The message's payload borrows `cdr`. Payloads are aligned to 8 if `cdr` starts 4
// bytes before a multiple of 8, which holds for Cyclone's buffers.
bool ParseCdr(std::span<const uint8_t> cdr, TransitionChunk* message);
bool ParseCdr(std::span<const uint8_t> cdr, BatchPart* message);
bool ParseCdr(std::span<const uint8_t> cdr, WeightsPart* message);

}  // namespace shoal::dds
