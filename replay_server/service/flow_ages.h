// SPDX-License-Identifier: Apache-2.0
// Measures the age of data in the replay: the policy lag of stored records, the time until a record
// is stored, and the age of the steps in a batch.
//
// The number of finished updates is computed from the learner's requests. With C outstanding
// requests, request r is sent when update r - C begins; at this time, r - C - 1 updates are
// finished.
#pragma once

#include <cstdint>

#include "common/spec/record.h"
#include "common/wire/messages.h"
#include "common/wire/metrics_report.h"
#include "replay_server/core/batch_gather.h"
#include "replay_server/core/ring.h"

namespace shoal::replay {

// Times are wall-clock nanoseconds since 1970. If actor and replay are on different hosts, an age
// is only as exact as the clocks of the hosts. Only one thread may use an object.
class FlowAges {
 public:
  FlowAges(const RecordLayout& layout, int request_credits)
      : layout_(layout), request_credits_(static_cast<uint64_t>(request_credits)) {}

  void OnRequest(const SampleRequest& request);
  // Records the ages of a chunk that was processed.
  void OnChunk(const TransitionChunk& chunk, int64_t now_ns);
  // Records the ages of the steps of a batch that was drawn.
  void OnBatch(const BatchPlan& plan, const Ring& ring, int64_t now_ns);
  // Adds policy_lag (updates), store_age_seconds and data_age_seconds of the interval that ended.
  void Report(MetricsReport* report);

 private:
  const RecordLayout layout_;
  const uint64_t request_credits_;
  uint64_t learner_session_ = 0, updates_ = 0;
  QuantileWindow policy_lag_, store_age_, data_age_;
};

}  // namespace shoal::replay
