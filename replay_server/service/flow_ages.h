// SPDX-License-Identifier: Apache-2.0
// How old things are as they pass through the replay: how far behind the learner the policy was
// that acted, how long a record took to be stored, how old the steps of a batch are.
//
// The learner's progress is known by its requests: with C requests kept outstanding, number r is
// sent when update r - C begins, so r - C - 1 updates are done.
#pragma once

#include <cstdint>

#include "common/spec/record.h"
#include "common/wire/messages.h"
#include "common/wire/metrics_report.h"
#include "replay_server/core/batch_gather.h"
#include "replay_server/core/ring.h"

namespace shoal::replay {

// Times are wall-clock nanoseconds since 1970: between hosts, ages are as good as their clocks. One
// thread.
class FlowAges {
 public:
  FlowAges(const RecordLayout& layout, int request_credits)
      : layout_(layout), request_credits_(static_cast<uint64_t>(request_credits)) {}

  void OnRequest(const SampleRequest& request);
  // A chunk that was dealt with.
  void OnChunk(const TransitionChunk& chunk, int64_t now_ns);
  // The steps of a batch that was drawn.
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
