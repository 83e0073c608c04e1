// SPDX-License-Identifier: Apache-2.0
#include "learner/pending_evaluations.h"

namespace shoal::learner {

void PendingEvaluations::Add(uint64_t updates, const std::string& checkpoint) {
  const MutexLock lock(mutex_);
  pending_[updates] = checkpoint;
  if (pending_.size() > kMost) pending_.erase(pending_.begin());
}

void PendingEvaluations::OnEvaluated(uint64_t updates) {
  const MutexLock lock(mutex_);
  pending_.erase(pending_.begin(), pending_.lower_bound(updates));
}

std::set<std::string> PendingEvaluations::Names() const {
  const MutexLock lock(mutex_);
  std::set<std::string> names;
  for (const auto& [updates, name] : pending_) names.insert(name);
  return names;
}

}  // namespace shoal::learner
