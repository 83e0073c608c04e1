// SPDX-License-Identifier: Apache-2.0
// Parses messages that are not bulk messages from serialised CDR. Shoal does not use the parser of
// the DDS library: if a sample ends within an 8-byte number, version 0.10.2 of the library reads
// past the end of the sample (docs/decisions/0006-messages-are-parsed-here.md).
//
//   0x00 0x09 (delimited CDR 2, little-endian) | 2 bytes options | body
#pragma once

#include <cstdint>
#include <span>

#include "common/wire/messages.h"

namespace shoal::dds {

// The functions return false if the bytes are truncated or inconsistent; `message` is then
// unspecified. If an older sender left out a field at the end of a struct, the field is zero or
// empty. OneLine removes control characters from all texts except an evaluation's JSON.
bool ParseCdr(std::span<const uint8_t> cdr, CreditsMessage* message);
bool ParseCdr(std::span<const uint8_t> cdr, SampleRequest* message);
bool ParseCdr(std::span<const uint8_t> cdr, BatchSlot* message);
bool ParseCdr(std::span<const uint8_t> cdr, MetricsMessage* message);
bool ParseCdr(std::span<const uint8_t> cdr, ReplayProgress* message);
bool ParseCdr(std::span<const uint8_t> cdr, LearnerProgress* message);
bool ParseCdr(std::span<const uint8_t> cdr, ControlMessage* message);
bool ParseCdr(std::span<const uint8_t> cdr, EvalMessage* message);
bool ParseCdr(std::span<const uint8_t> cdr, RunViewMessage* message);
bool ParseCdr(std::span<const uint8_t> cdr, CommandMessage* message);
bool ParseCdr(std::span<const uint8_t> cdr, ReplyMessage* message);

}  // namespace shoal::dds
