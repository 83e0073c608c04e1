// SPDX-License-Identifier: Apache-2.0
// Counts of the records and chunks that a receiver has received since its start, by outcome.
#pragma once

#include <cstdint>

#include "common/intake/chunk_intake.h"

namespace shoal {

struct IntakeCounters {
  uint64_t records = 0;  // records that were stored or used
  uint64_t rejected = 0, after_gap = 0, duplicates = 0, lost = 0;
  uint64_t ahead_chunks = 0, superseded_chunks = 0, wrong_spec_chunks = 0, malformed_chunks = 0;
  uint64_t table_full_chunks = 0, future_chunks = 0;

  void Count(const ChunkResult& result);
  // Number of chunks that were refused as a whole. The actor need not send such a chunk again.
  uint64_t refused_chunks() const {
    return superseded_chunks + wrong_spec_chunks + malformed_chunks + table_full_chunks +
           future_chunks;
  }
};

}  // namespace shoal
