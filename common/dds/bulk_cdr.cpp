// SPDX-License-Identifier: Apache-2.0
#include "common/dds/bulk_cdr.h"

#include "common/base/one_line.h"
#include "common/dds/cdr_reader.h"

namespace shoal::dds {
namespace {

CdrReader Reader(std::span<const uint8_t> cdr) { return {cdr, CdrEncoding::kPlain1}; }

}  // namespace

bool ParseCdr(std::span<const uint8_t> cdr, TransitionChunk* message) {
  CdrReader reader = Reader(cdr);
  const auto version = reader.Read<uint8_t>();
  message->actor = reader.Read<uint32_t>();
  message->spec_hash = reader.Read<uint64_t>();
  message->session = reader.Read<uint64_t>();
  message->first_sequence = reader.Read<uint64_t>();
  message->count = reader.Read<uint32_t>();
  message->payload = reader.ReadBytes();
  const bool sized = message->count == 0 ? message->payload.empty()
                                         : !message->payload.empty() &&
                                               message->payload.size() % message->count == 0;
  return reader.Finished() && version == kBulkVersion && sized && message->first_sequence > 0 &&
         message->first_sequence <= UINT64_MAX - message->count;
}

bool ParseCdr(std::span<const uint8_t> cdr, BatchPart* message) {
  CdrReader reader = Reader(cdr);
  const auto version = reader.Read<uint8_t>();
  message->part = reader.Read<uint32_t>();
  message->spec_hash = reader.Read<uint64_t>();
  message->learner_session = reader.Read<uint64_t>();
  message->request = reader.Read<uint64_t>();
  message->offset = reader.Read<uint64_t>();
  message->total_bytes = reader.Read<uint64_t>();
  message->stored_records = reader.Read<uint64_t>();
  message->stored_steps = reader.Read<uint64_t>();
  message->unsampleable_steps = reader.Read<uint64_t>();
  message->parts = reader.Read<uint32_t>();
  message->payload = reader.ReadBytes();
  return reader.Finished() && version == kBatchPartVersion && message->part < message->parts &&
         !message->payload.empty() && message->offset <= message->total_bytes &&
         message->payload.size() <= message->total_bytes - message->offset;
}

bool ParseCdr(std::span<const uint8_t> cdr, WeightsPart* message) {
  CdrReader reader = Reader(cdr);
  const auto version = reader.Read<uint8_t>();
  message->part = reader.Read<uint32_t>();
  message->spec_hash = reader.Read<uint64_t>();
  message->version.session = reader.Read<uint64_t>();
  message->version.update = reader.Read<uint64_t>();
  message->env_steps = reader.Read<uint64_t>();
  message->total_bytes = reader.Read<uint64_t>();
  message->crc = reader.Read<uint32_t>();
  message->payload = reader.ReadBytes();
  message->checkpoint = OneLine(reader.ReadString());
  return reader.Finished() && version == kWeightsVersion && message->version.session > 0 &&
         !message->payload.empty() && message->payload.size() <= message->total_bytes;
}

}  // namespace shoal::dds
