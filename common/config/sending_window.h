// SPDX-License-Identifier: Apache-2.0
// The window of unacknowledged records of an actor and the size of its chunks. Actors and replay
// compute both from the configuration and must agree.
//
//   per chunk  transport.chunk_records, or fewer (at least one) so that a chunk fits kChunkBytes
//   chunks     chunks for replay.window_chunks * transport.chunk_records records
//   least      records for which an actor needs credit to make progress: its oldest chunk, and a
//              reset and a step of each of its environments, with the goal record before the reset
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/config/config.h"

namespace shoal {

// The transport is fastest with samples from 64 kB to 2 MB; much larger ones stall it.
inline constexpr int64_t kChunkBytes = 1 << 20;

struct SendingWindow {
  int chunk_records = 0;  // >= 1
  int chunks = 0;         // >= 2
  int least_records = 0;

  int64_t records() const { return int64_t{chunk_records} * chunks; }
};

// Most records that an environment makes in one step: a reset and a step and, if the policy sees
// goal pictures, a goal record before them.
constexpr int MostRecordsOfStep(bool goal_pictures) { return goal_pictures ? 3 : 2; }

// `record_bytes` > 0: RecordLayout::record_bytes().
SendingWindow SendingWindowOf(const Config& config, int record_bytes);

// Throws Error (usage) when the environments of an actor do not fit its window.
void CheckSendingWindow(const Config& config, int record_bytes);

inline uint64_t ChunkBytes(const SendingWindow& window, int record_bytes) {
  return static_cast<uint64_t>(window.chunk_records) * static_cast<uint64_t>(record_bytes);
}

// Most chunks that are in transit to a receiver at once. Each actor session, and one spare session,
// may have its whole window in transit: full chunks and one partial chunk, twice if the actor
// resends them.
inline size_t MostChunks(const SendingWindow& window, size_t sessions) {
  return (sessions + 1) * 2 * static_cast<size_t>(window.chunks + 1);
}

}  // namespace shoal
