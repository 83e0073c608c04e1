// SPDX-License-Identifier: Apache-2.0
#include "common/intake/intake_counters.h"

namespace shoal {

void IntakeCounters::Count(const ChunkResult& result) {
  switch (result.fate) {
    case ChunkFate::kDealtWith:
      break;
    case ChunkFate::kAhead:
      ++ahead_chunks;
      break;
    case ChunkFate::kSuperseded:
      ++superseded_chunks;
      break;
    case ChunkFate::kFuture:
      ++future_chunks;
      break;
    case ChunkFate::kWrongSpec:
      ++wrong_spec_chunks;
      break;
    case ChunkFate::kMalformed:
      ++malformed_chunks;
      break;
    case ChunkFate::kTableFull:
      ++table_full_chunks;
      break;
  }
  records += result.stored;
  rejected += result.rejected;
  after_gap += result.after_gap;
  duplicates += result.duplicates;
  lost += result.lost;
}

}  // namespace shoal
