// SPDX-License-Identifier: Apache-2.0
#include "common/dds/bulk_cdr.h"

#include "common/dds/read_fields.h"

namespace shoal::dds {
namespace {

// Reads the fields of a message. False if the bytes are not a whole message of the present version.
template <class M>
bool ReadBulk(std::span<const uint8_t> cdr, M* message) {
  CdrReader reader(cdr, CdrEncoding::kPlain1);
  const auto version = reader.Read<uint8_t>();
  FieldReader(&reader).ReadAll(message);
  return reader.Finished() && version == BulkVersion(message);
}

}  // namespace

bool ParseCdr(std::span<const uint8_t> cdr, TransitionChunk* message) {
  if (!ReadBulk(cdr, message)) return false;
  const bool sized = message->count == 0 ? message->payload.empty()
                                         : !message->payload.empty() &&
                                               message->payload.size() % message->count == 0;
  return sized && message->first_sequence > 0 &&
         message->first_sequence <= UINT64_MAX - message->count;
}

bool ParseCdr(std::span<const uint8_t> cdr, BatchPart* message) {
  return ReadBulk(cdr, message) && message->part < message->parts && !message->payload.empty() &&
         message->offset <= message->total_bytes &&
         message->payload.size() <= message->total_bytes - message->offset;
}

bool ParseCdr(std::span<const uint8_t> cdr, WeightsPart* message) {
  return ReadBulk(cdr, message) && message->version.session > 0 && !message->payload.empty() &&
         message->payload.size() <= message->total_bytes;
}

}  // namespace shoal::dds
