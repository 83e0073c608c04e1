// SPDX-License-Identifier: Apache-2.0
// Batch requests of the learner, answered in the order of their ids.
//
// Bounded by the learner's credits. A new learner session discards the old one's requests. A
// request that comes again while it waits is the same request; one that was answered is answered
// again, at no charge to the rate limiter; one that the learner is done with waits no more.
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
  kWrongSchema,  // other arrays, or filled in another way
  kFull,         // more than the credits allow; the learner asks again
};

class RequestQueue {
 public:
  RequestQueue(uint64_t spec_hash, uint64_t schema_hash, int credits)
      : spec_hash_(spec_hash), schema_hash_(schema_hash), credits_(static_cast<size_t>(credits)) {}

  RequestFate Offer(const SampleRequest& request);

  // The next request, if it may be served now that `stored_steps` step records are stored.
  std::optional<SampleRequest> Next(uint64_t stored_steps) const;
  // It was answered before: the learner did not get it.
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
