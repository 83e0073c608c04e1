// SPDX-License-Identifier: Apache-2.0
// Logs how many records were lost, and how many records and requests were refused: in each interval
// one line for each kind of problem.
#pragma once

#include <cstdint>

#include "common/base/clock.h"
#include "common/intake/intake_problems.h"
#include "common/wire/messages.h"
#include "replay_server/core/replay_core.h"

namespace shoal::replay {

class ProblemLog {
 public:
  // Borrows the schema.
  ProblemLog(uint64_t spec_hash, const BatchSchema& schema)
      : spec_hash_(spec_hash), schema_(schema), intake_(spec_hash, "replay server") {}

  // Stores the chunk's problem as the example for the next line.
  void Note(const TransitionChunk& chunk, const ChunkResult& result) {
    intake_.Note(chunk, result);
  }
  void NoteRefused(const SampleRequest& request) { refused_request_ = request; }
  // Logs the counts that have increased since the last report, at most once in each
  // IntakeProblems::kInterval.
  void Report(SteadyTime now, const CoreCounters& counters, uint64_t dropped_chunks);

 private:
  const uint64_t spec_hash_;
  const BatchSchema& schema_;
  IntakeProblems intake_;
  uint64_t reported_requests_ = 0;
  SampleRequest refused_request_;
};

}  // namespace shoal::replay
