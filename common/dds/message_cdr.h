// SPDX-License-Identifier: Apache-2.0
// Parses the messages that are not bulk from serialised CDR. Not left to the DDS library: 0.10.2
// reads past the end of a sample whose numbers of eight bytes are cut short
// (docs/decisions/0006-messages-are-parsed-here.md).
//
//   0x00 0x09 (delimited CDR 2, little-endian) | 2 bytes options | body
#pragma once

#include <cstdint>
#include <span>

#include "common/wire/messages.h"

namespace shoal::dds {

// False when the bytes are truncated or make no sense; `message` is then unspecified. A field that
// an older sender left out at the end of a struct is zero or empty. Texts but an evaluation's JSON
// hold no control characters (OneLine).
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
