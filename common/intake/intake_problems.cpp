// SPDX-License-Identifier: Apache-2.0
#include "common/intake/intake_problems.h"

#include <utility>

#include "common/base/log.h"

namespace shoal {

void IntakeProblems::Note(const TransitionChunk& chunk, const ChunkResult& result) {
  if (result.fate == ChunkFate::kWrongSpec) {
    other_spec_ = chunk.spec_hash;
    other_spec_actor_ = chunk.actor;
  }
  if (result.fate == ChunkFate::kFuture) {
    future_actor_ = chunk.actor;
    future_session_ = chunk.session;
  }
  if (result.fault != nullptr) {
    fault_ = result.fault;
    fault_actor_ = chunk.actor;
  }
}

bool IntakeProblems::Report(SteadyTime now, const IntakeCounters& counters,
                            uint64_t dropped_chunks) {
  if (now - last_ < kInterval) return false;
  last_ = now;
  const IntakeCounters before = std::exchange(reported_, counters);
  ReportChunks(counters, before);
  ReportRecords(counters, before);
  if (dropped_chunks > reported_drops_) {
    log::Warning("{} chunks dropped: no buffer was free; their actors send them again",
                 dropped_chunks - reported_drops_);
  }
  reported_drops_ = dropped_chunks;
  return true;
}

// Superseded chunks are no problem, because their actor's process has ended. The receiver itself
// reports a full table.
void IntakeProblems::ReportChunks(const IntakeCounters& counters,
                                  const IntakeCounters& before) const {
  if (const uint64_t n = counters.wrong_spec_chunks - before.wrong_spec_chunks) {
    log::Warning("{} chunks refused: actor {} has observation spec {:016x}, the run has {:016x}", n,
                 other_spec_actor_, other_spec_, spec_hash_);
  }
  if (const uint64_t n = counters.future_chunks - before.future_chunks) {
    log::Warning(
        "{} chunks refused: actor {} says that its session begins at {:.0f} s from now: is its "
        "host's clock right?",
        n, future_actor_,
        1e-9 * (static_cast<double>(future_session_) - static_cast<double>(WallTimeNs())));
  }
  if (const uint64_t n = counters.malformed_chunks - before.malformed_chunks) {
    log::Warning("{} chunks refused: their length or sequences are invalid", n);
  }
}

void IntakeProblems::ReportRecords(const IntakeCounters& counters,
                                   const IntakeCounters& before) const {
  if (const uint64_t n = counters.rejected - before.rejected) {
    log::Warning("{} records rejected; the last one, of actor {}: {}", n, fault_actor_, fault_);
  }
  if (const uint64_t n = counters.after_gap - before.after_gap) {
    log::Warning("{} records not used: an earlier one of their episode is missing", n);
  }
  if (const uint64_t n = counters.lost - before.lost) {
    log::Warning("{} records are lost: they were in the memory of an earlier {}", n, receiver_);
  }
}

}  // namespace shoal
