// SPDX-License-Identifier: Apache-2.0
// Counts of the chunks that a receiver took, by outcome, over the life of its process.
#pragma once

#include <cstdint>

#include "common/intake/chunk_intake.h"

namespace shoal {

struct IntakeCounters {
  uint64_t records = 0;  // taken
  uint64_t rejected = 0, after_gap = 0, duplicates = 0, lost = 0;
  uint64_t ahead_chunks = 0, superseded_chunks = 0, wrong_spec_chunks = 0, malformed_chunks = 0;
  uint64_t table_full_chunks = 0, future_chunks = 0;

  void Count(const ChunkResult& result);
  // Chunks of which no record is taken and that the actor need not send again.
  uint64_t refused_chunks() const {
    return superseded_chunks + wrong_spec_chunks + malformed_chunks + table_full_chunks +
           future_chunks;
  }
};

}  // namespace shoal
