// SPDX-License-Identifier: Apache-2.0
// Plans of batches that the learner has not released. With priorities, a second draw for the same
// request would find other priorities. A request that is repeated therefore gets the plan of its
// first answer.
//
// Not thread-safe, one owner.
#pragma once

#include <cstdint>
#include <map>

#include "common/wire/messages.h"
#include "replay_server/core/batch_gather.h"

namespace shoal::replay {

class DrawnPlans {
 public:
  // Drops the plans that the request releases and those of other learner sessions.
  void OnRequest(const SampleRequest& request) {
    if (request.learner_session != learner_session_) plans_.clear();
    learner_session_ = request.learner_session;
    plans_.erase(plans_.begin(), plans_.upper_bound(request.released));
  }
  void Keep(uint64_t request, const BatchPlan& plan) { plans_[request] = plan; }
  // Null if there is no plan of this request.
  const BatchPlan* Find(uint64_t request) const {
    const auto found = plans_.find(request);
    return found == plans_.end() ? nullptr : &found->second;
  }

 private:
  uint64_t learner_session_ = 0;
  std::map<uint64_t, BatchPlan> plans_;  // by request
};

}  // namespace shoal::replay
