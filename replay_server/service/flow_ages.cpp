// SPDX-License-Identifier: Apache-2.0
#include "replay_server/service/flow_ages.h"

#include <algorithm>

namespace shoal::replay {
namespace {

// `from_ns` comes from a message and may be any integer.
double Seconds(int64_t from_ns, int64_t to_ns) {
  return 1e-9 * (static_cast<double>(to_ns) - static_cast<double>(from_ns));
}

}  // namespace

void FlowAges::OnRequest(const SampleRequest& request) {
  if (request.learner_session < learner_session_) return;
  if (request.learner_session > learner_session_) {
    learner_session_ = request.learner_session;
    updates_ = 0;
  }
  const uint64_t begun = request.request - std::min(request.request, request_credits_);
  updates_ = std::max(updates_, begun - std::min<uint64_t>(begun, 1));
}

void FlowAges::OnChunk(const TransitionChunk& chunk, int64_t now_ns) {
  const auto size = static_cast<size_t>(layout_.record_bytes());
  for (size_t at = 0; at + size <= chunk.payload.size(); at += size) {
    const RecordHeader& header = RecordLayout::Header(chunk.payload.data() + at);
    store_age_.Add(Seconds(header.time_ns, now_ns));
    if (header.weights_session == 0) continue;  // a random action belongs to no policy
    policy_lag_.Add(static_cast<double>(updates_ - std::min(updates_, header.weights_update)));
  }
}

void FlowAges::OnBatch(const BatchPlan& plan, const Ring& ring, int64_t now_ns) {
  for (const BatchPlan::Element& element : plan.elements) {
    data_age_.Add(Seconds(ring.Header(element.id).time_ns, now_ns));
  }
}

void FlowAges::Report(MetricsReport* report) {
  report->AddQuantiles("policy_lag", &policy_lag_);
  report->AddQuantiles("store_age_seconds", &store_age_);
  report->AddQuantiles("data_age_seconds", &data_age_);
}

}  // namespace shoal::replay
