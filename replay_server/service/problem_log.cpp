// SPDX-License-Identifier: Apache-2.0
#include "replay_server/service/problem_log.h"

#include <utility>

#include "common/base/log.h"

namespace shoal::replay {

void ProblemLog::Report(SteadyTime now, const CoreCounters& counters, uint64_t dropped_chunks) {
  if (!intake_.Report(now, counters.intake, dropped_chunks)) return;
  const uint64_t before = std::exchange(reported_requests_, counters.refused_requests);
  if (const uint64_t n = counters.refused_requests - before) {
    log::Warning(
        "{} batch requests refused; the last one, of {}: spec {:016x} (the run's {:016x}), schema "
        "{:016x} (the run's {:016x}: {})",
        n, refused_request_.batch, refused_request_.spec_hash, spec_hash_,
        refused_request_.schema_hash, schema_.Hash(), schema_.Summary());
  }
}

}  // namespace shoal::replay
