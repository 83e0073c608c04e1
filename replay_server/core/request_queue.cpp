// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/request_queue.h"

#include <algorithm>

#include "common/base/check.h"

namespace shoal::replay {

RequestFate RequestQueue::Offer(const SampleRequest& request) {
  if (request.spec_hash != spec_hash_) return RequestFate::kWrongSpec;
  if (request.schema_hash != schema_hash_) return RequestFate::kWrongSchema;
  if (request.learner_session < learner_session_) return RequestFate::kStale;
  if (request.learner_session > learner_session_) {
    learner_session_ = request.learner_session;
    answered_ = 0;
    waiting_.clear();
  }
  waiting_.erase(waiting_.begin(), waiting_.upper_bound(request.released));
  if (waiting_.contains(request.request)) return RequestFate::kAlreadyQueued;
  if (waiting_.size() >= credits_) return RequestFate::kFull;
  waiting_.emplace(request.request, request);
  return RequestFate::kQueued;
}

std::optional<SampleRequest> RequestQueue::Next(uint64_t stored_steps) const {
  if (waiting_.empty()) return std::nullopt;
  const SampleRequest& request = waiting_.begin()->second;
  if (request.after_steps > stored_steps) return std::nullopt;
  return request;
}

void RequestQueue::Pop() {
  CHECK(!waiting_.empty());
  answered_ = std::max(answered_, waiting_.begin()->first);
  waiting_.erase(waiting_.begin());
}

}  // namespace shoal::replay
