// Losses and refusals, logged once per interval as one line each, with their numbers.
#pragma once

#include <chrono>
#include <cstdint>

#include "common/base/clock.h"
#include "common/wire/messages.h"
#include "replay_server/core/replay_core.h"

namespace shoal::replay {

class ProblemLog {
 public:
  static constexpr std::chrono::seconds kInterval{10};

  // Borrows the schema.
  ProblemLog(uint64_t spec_hash, const BatchSchema& schema)
      : spec_hash_(spec_hash), schema_(schema) {}

  // Remembers the example that the next line will name.
  void Note(const TransitionChunk& chunk, const ChunkResult& result);
  void NoteRefused(const SampleRequest& request) { refused_request_ = request; }
  // Logs what has grown since the last line, at most once per interval.
  void Report(SteadyTime now, const CoreCounters& counters, uint64_t dropped_chunks);

 private:
  const uint64_t spec_hash_;
  const BatchSchema& schema_;
  SteadyTime last_{};
  CoreCounters reported_;
  uint64_t reported_drops_ = 0;
  uint64_t other_spec_ = 0;
  uint32_t other_spec_actor_ = 0;
  uint32_t future_actor_ = 0;
  uint64_t future_session_ = 0;
  const char* fault_ = "";
  uint32_t fault_actor_ = 0;
  SampleRequest refused_request_;
};

}  // namespace shoal::replay
