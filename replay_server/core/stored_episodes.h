// SPDX-License-Identifier: Apache-2.0
// Whole episodes in a ring, from the reset to the last record, for `shoal replay export`.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "replay_server/core/ring.h"

namespace shoal::replay {

struct StoredEpisodes {
  // Record ids of each whole episode, the reset first, without goal records. Episodes are in the
  // order of their ends.
  std::vector<std::vector<uint64_t>> whole;
  // Number of episodes whose first records were overwritten; usually at most one per environment.
  uint64_t overwritten = 0;
  uint64_t unended = 0;  // number of episodes that have not ended or were cut
};

// Finds the episodes of a ring. Every record belongs to an episode that is listed or counted. A
// server may be writing to the ring at the same time; CopyEpisode detects overwritten records.
StoredEpisodes FindEpisodes(const Ring& ring);

// The records of an episode one after the other, layout().record_bytes() bytes each. Empty if a
// server has overwritten one of the records.
std::optional<std::vector<uint8_t>> CopyEpisode(const Ring& ring, const std::vector<uint64_t>& ids);

}  // namespace shoal::replay
