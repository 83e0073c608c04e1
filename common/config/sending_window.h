// SPDX-License-Identifier: Apache-2.0
// The window of unacknowledged records of an actor, and the size of its chunks. Actors and replay
// each compute these numbers from the configuration and get the same result.
//
//   chunk_records   transport.chunk_records, or fewer (at least one) so that a chunk has at most
//                   kChunkBytes bytes
//   chunks          chunks for replay.window_chunks * transport.chunk_records records
//   least_records   records for which an actor needs credit to make progress: its oldest chunk, and
//                   a reset and a step of each of its environments, with the goal record before
//                   the reset
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/config/config.h"

namespace shoal {

// The transport is fastest with messages of 64 kB to 2 MB. Much larger messages stall the
// transport.
inline constexpr int64_t kChunkBytes = 1 << 20;

struct SendingWindow {
  int chunk_records = 0;  // >= 1
  int chunks = 0;         // >= 2
  int least_records = 0;

  int64_t records() const { return int64_t{chunk_records} * chunks; }
};

// Most records that an environment makes in one step: a reset record, a step record and, if the
// policy observes goal pictures, a goal record.
constexpr int MostRecordsOfStep(bool goal_pictures) { return goal_pictures ? 3 : 2; }

// `record_bytes` > 0: RecordLayout::record_bytes().
SendingWindow SendingWindowOf(const Config& config, int record_bytes);

// Throws Error (kUsage) if an actor's window is too small for the number of its environments.
void CheckSendingWindow(const Config& config, int record_bytes);

inline uint64_t ChunkBytes(const SendingWindow& window, int record_bytes) {
  return static_cast<uint64_t>(window.chunk_records) * static_cast<uint64_t>(record_bytes);
}

// Most chunks that are in transit to a receiver at one time. Each actor session, and one spare
// session, may have its whole window in transit: the full chunks and one partial chunk. If the
// actor resends its chunks, each of them is in transit twice.
inline size_t MostChunks(const SendingWindow& window, size_t sessions) {
  return (sessions + 1) * 2 * static_cast<size_t>(window.chunks + 1);
}

}  // namespace shoal
