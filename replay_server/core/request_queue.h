// SPDX-License-Identifier: Apache-2.0
// Batch requests of the learner, answered in the order of their ids.
//
// The queue is bounded by the learner's credits. A new learner session discards the requests of the
// old one. A request that arrives again while it waits is queued once. A request that was answered
// is answered again, at no charge to the rate limiter. A request that the learner has finished with
// is removed.
//
// Threads: none inside; one owner.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "common/wire/messages.h"

namespace shoal::replay {

enum class RequestFate {
  kQueued,
  kAlreadyQueued,
  kStale,        // of a learner session that has been replaced
  kWrongSpec,    // another observation spec
  kWrongSchema,  // other arrays, or arrays with another definition
  kFull,         // more than the credits allow; the learner asks again
};

class RequestQueue {
 public:
  RequestQueue(uint64_t spec_hash, uint64_t schema_hash, int credits)
      : spec_hash_(spec_hash), schema_hash_(schema_hash), credits_(static_cast<size_t>(credits)) {}

  RequestFate Offer(const SampleRequest& request);

  // The next request, if it may be served now that `stored_steps` step records are stored.
  std::optional<SampleRequest> Next(uint64_t stored_steps) const;
  // Whether the request was answered before: the learner did not get the batch.
  bool Answered(const SampleRequest& request) const { return request.request <= answered_; }
  // Removes the request that Next() returned.
  void Pop();

  size_t size() const { return waiting_.size(); }
  uint64_t learner_session() const { return learner_session_; }

 private:
  const uint64_t spec_hash_, schema_hash_;
  const size_t credits_;
  uint64_t learner_session_ = 0;
  uint64_t answered_ = 0;                      // highest request answered in this session
  std::map<uint64_t, SampleRequest> waiting_;  // by request
};

}  // namespace shoal::replay
