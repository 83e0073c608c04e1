// SPDX-License-Identifier: Apache-2.0
// Checkpoints that must not be removed, because their evaluation is pending or because the
// coordinator may be copying them as the best checkpoint. Evaluations arrive in order: if an
// evaluation of a checkpoint arrives, all earlier checkpoints were evaluated or skipped.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "common/base/mutex.h"

namespace shoal::learner {

// Any thread may use this class.
class PendingEvaluations {
 public:
  // Adds a checkpoint whose parameters were sent to the evaluation actor. If there are more than
  // kMost checkpoints, the oldest one is dropped, so that the disk does not fill if there is no
  // evaluation actor.
  void Add(uint64_t updates, const std::string& checkpoint);
  // Call this function when an evaluation of the checkpoint with `updates` has arrived. Removes all
  // earlier checkpoints. The evaluated checkpoint stays until a later evaluation arrives, because
  // the coordinator may be copying it.
  void OnEvaluated(uint64_t updates);
  std::set<std::string> Names() const;

  static constexpr size_t kMost = 6;

 private:
  mutable Mutex mutex_;
  std::map<uint64_t, std::string> pending_ SHOAL_GUARDED_BY(mutex_);  // by updates
};

}  // namespace shoal::learner
