// SPDX-License-Identifier: Apache-2.0
// Checkpoints that must not be removed, because their evaluation is pending or the coordinator may
// be copying them as the best. Evaluations arrive in order: an evaluation of one checkpoint means
// that earlier ones were evaluated or skipped.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "common/base/mutex.h"

namespace shoal::learner {

// Threads: any.
class PendingEvaluations {
 public:
  // A checkpoint was handed to the evaluation actor. Beyond kMost the oldest is dropped, so that
  // the disk does not fill without an evaluation actor.
  void Add(uint64_t updates, const std::string& checkpoint);
  // An evaluation of the checkpoint with `updates` has arrived. The checkpoint itself stays until a
  // later evaluation arrives, because the coordinator may be copying the checkpoint.
  void OnEvaluated(uint64_t updates);
  std::set<std::string> Names() const;

  static constexpr size_t kMost = 6;

 private:
  mutable Mutex mutex_;
  std::map<uint64_t, std::string> pending_ SHOAL_GUARDED_BY(mutex_);  // by updates
};

}  // namespace shoal::learner
