// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/ring_format.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string_view>

#include "common/base/random.h"

namespace shoal::replay {

uint64_t SlotCommit(const RingGeometry& geometry, const SlotHeader& slot, const uint8_t* record) {
  const auto* bytes = reinterpret_cast<const uint8_t*>(&slot) + sizeof(slot.commit);
  const uint64_t head = HashBytes(bytes, sizeof(SlotHeader) - sizeof(slot.commit));
  return std::max<uint64_t>(1, HashWords({head, HashBytes(record, geometry.prefix_bytes)}));
}

RingHeader MakeRingHeader(const RingGeometry& geometry, uint64_t spec_hash, const char* run) {
  RingHeader header = {};
  std::memcpy(header.magic, kRingMagic, sizeof(kRingMagic));
  header.version = kRingVersion;
  header.max_sessions = kMaxSessions;
  header.spec_hash = spec_hash;
  header.record_bytes = geometry.record_bytes;
  header.slot_bytes = geometry.slot_bytes();
  header.capacity = geometry.capacity;
  const std::string_view name(run);
  std::memcpy(header.run, name.data(), std::min(name.size(), sizeof(header.run) - 1));
  header.check = HashBytes(&header, offsetof(RingHeader, check));
  return header;
}

}  // namespace shoal::replay
