// SPDX-License-Identifier: Apache-2.0
// Whole episodes in a ring: from the reset to the record that ended them. For `shoal replay
// export`.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "replay_server/core/ring.h"

namespace shoal::replay {

struct StoredEpisodes {
  // Record ids, reset first (goal records are left out); the episode that ended first comes first.
  std::vector<std::vector<uint64_t>> whole;
  uint64_t overwritten =
      0;  // episodes without their first records; usually at most one per environment
  uint64_t unended = 0;  // episodes that run or were cut: neither terminated nor truncated
};

// Every record of the ring belongs to one of the episodes counted or listed. A server may be
// writing to the ring meanwhile; CopyEpisode detects overwritten records.
StoredEpisodes FindEpisodes(const Ring& ring);

// The records of an episode one after the other, layout().record_bytes() each. Empty if a server
// has overwritten one of them since.
std::optional<std::vector<uint8_t>> CopyEpisode(const Ring& ring, const std::vector<uint64_t>& ids);

}  // namespace shoal::replay
