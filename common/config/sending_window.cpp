// SPDX-License-Identifier: Apache-2.0
#include "common/config/sending_window.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/config/on_policy.h"

namespace shoal {
namespace {

// Most records that all environments of an actor make at once.
int64_t MostRecords(const Config& config) {
  return int64_t{MostRecordsOfStep(config.observation.goal_mode == "image")} *
         config.envs_per_actor;
}

}  // namespace

SendingWindow SendingWindowOf(const Config& config, int record_bytes) {
  const int asked = config.transport.chunk_records;
  const int64_t asked_in_all = int64_t{asked} * std::max(2, config.replay.window_chunks);
  const int fitting = static_cast<int>(std::max<int64_t>(1, kChunkBytes / record_bytes));
  const int chunk_records = std::min(asked, fitting);
  return {.chunk_records = chunk_records,
          .chunks = static_cast<int>(asked_in_all / chunk_records),
          .least_records = std::max(chunk_records, static_cast<int>(MostRecords(config)))};
}

void CheckSendingWindow(const Config& config, int record_bytes) {
  const SendingWindow window = SendingWindowOf(config, record_bytes);
  if (MostRecords(config) <= window.records()) return;
  throw UsageError("envs_per_actor {} does not fit the window of {} chunks of {} records: raise {}",
                   config.envs_per_actor, window.chunks, window.chunk_records,
                   LearnsOnPolicy(config) ? "transport.chunk_records"
                                          : "replay.window_chunks or transport.chunk_records");
}

}  // namespace shoal
