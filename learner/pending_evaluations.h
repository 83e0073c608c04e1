// SPDX-License-Identifier: Apache-2.0
// Which checkpoints an evaluation is still waited for, or may just be being kept as the best: they
// are not removed. An evaluation says that the ones before it were done or passed over.
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
  // A checkpoint was handed to the evaluation actor. Beyond kMost the oldest is let go, so that
  // without an evaluation actor the disk does not fill.
  void Add(uint64_t updates, const std::string& checkpoint);
  // An evaluation of the checkpoint with `updates` has arrived. It stays itself, as the coordinator
  // may be copying it, until a later one arrives.
  void OnEvaluated(uint64_t updates);
  std::set<std::string> Names() const;

  static constexpr size_t kMost = 6;

 private:
  mutable Mutex mutex_;
  std::map<uint64_t, std::string> pending_ SHOAL_GUARDED_BY(mutex_);  // by updates
};

}  // namespace shoal::learner
