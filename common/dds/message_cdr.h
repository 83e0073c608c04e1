// SPDX-License-Identifier: Apache-2.0
// Parses the messages that are not bulk from serialised CDR. The DDS library does not parse them,
// because its version 0.10.2 reads past the end of a sample that ends within a number of eight
// bytes (docs/decisions/0006-messages-are-parsed-here.md).
//
//   0x00 0x09 (delimited CDR 2, little-endian) | 2 bytes options | body
#pragma once

#include <cstdint>
#include <span>

#include "common/wire/messages.h"

namespace shoal::dds {

// Returns false when the bytes are truncated or inconsistent; `message` is then unspecified. If an
// older sender left out a field at the end of a struct, the field is zero or empty. All texts
// except an evaluation's JSON are passed through OneLine, so they contain no control characters.
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
