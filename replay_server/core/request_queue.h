// SPDX-License-Identifier: Apache-2.0
// Batch requests of the learner, answered in the order of their ids.
//
// The number of requests is limited by the learner's credits. A new learner session discards the
// requests of the old session. If a waiting request arrives again, it stays in the queue once. If a
// request arrives again after it was answered, it is answered again; the rate limiter does not
// count the second answer. A request that the learner has released is removed.
//
// Starts no threads; not thread-safe, one owner.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "common/wire/messages.h"

namespace shoal::replay {

enum class RequestFate {
  kQueued,
  kAlreadyQueued,
  kStale,        // refused: the learner session has been replaced
  kWrongSpec,    // refused: another observation spec
  kWrongSchema,  // refused: other arrays, or arrays with another definition
  kFull,         // refused: more requests than credits; the learner sends the request again
};

class RequestQueue {
 public:
  RequestQueue(uint64_t spec_hash, uint64_t schema_hash, int credits)
      : spec_hash_(spec_hash), schema_hash_(schema_hash), credits_(static_cast<size_t>(credits)) {}

  RequestFate Offer(const SampleRequest& request);

  // The next request, if the number of stored step records, `stored_steps`, is high enough for it;
  // else empty.
  std::optional<SampleRequest> Next(uint64_t stored_steps) const;
  // Whether the request was answered before. The learner then did not get the batch.
  bool Answered(const SampleRequest& request) const { return request.request <= answered_; }
  // Removes the request that Next() returned.
  void Pop();

  size_t size() const { return waiting_.size(); }
  uint64_t learner_session() const { return learner_session_; }

 private:
  const uint64_t spec_hash_, schema_hash_;
  const size_t credits_;
  uint64_t learner_session_ = 0;
  uint64_t answered_ = 0;                      // highest answered request of this session
  std::map<uint64_t, SampleRequest> waiting_;  // by request
};

}  // namespace shoal::replay
