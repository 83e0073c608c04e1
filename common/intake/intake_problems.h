// SPDX-License-Identifier: Apache-2.0
// Logs the records that a receiver refused or lost: one line for each kind of problem in each
// interval, with a count and an example.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "common/base/clock.h"
#include "common/intake/intake_counters.h"
#include "common/wire/messages.h"

namespace shoal {

// Not thread-safe; one owner.
class IntakeProblems {
 public:
  static constexpr std::chrono::seconds kInterval{10};

  // `receiver`: name of the process in the log lines, such as "replay server".
  IntakeProblems(uint64_t spec_hash, std::string receiver)
      : spec_hash_(spec_hash), receiver_(std::move(receiver)) {}

  // Stores the chunk's problem as the example for the next line.
  void Note(const TransitionChunk& chunk, const ChunkResult& result);
  // Logs the counts that have increased since the last report. If less than kInterval has passed
  // since the last report, logs nothing and returns false.
  bool Report(SteadyTime now, const IntakeCounters& counters, uint64_t dropped_chunks);

 private:
  void ReportChunks(const IntakeCounters& counters, const IntakeCounters& before) const;
  void ReportRecords(const IntakeCounters& counters, const IntakeCounters& before) const;

  const uint64_t spec_hash_;
  const std::string receiver_;
  SteadyTime last_{};
  IntakeCounters reported_;
  uint64_t reported_drops_ = 0;
  uint64_t other_spec_ = 0;
  uint32_t other_spec_actor_ = 0;
  uint32_t future_actor_ = 0;
  uint64_t future_session_ = 0;
  const char* fault_ = "";
  uint32_t fault_actor_ = 0;
};

}  // namespace shoal
