// SPDX-License-Identifier: Apache-2.0
#include "actor/acting/weights_inbox.h"

#include <utility>

namespace shoal::actor {

void WeightsInbox::OnMessage(const WeightsPart& part) {
  const MutexLock lock(mutex_);
  const auto verdict =
      part.spec_hash == spec_hash_ ? assembler_.Add(part) : WeightsAssembler::Verdict::kRefused;
  if (verdict == WeightsAssembler::Verdict::kRefused) ++refused_;
  if (verdict != WeightsAssembler::Verdict::kComplete) return;
  if (newest_) ++overtaken_;
  newest_ = ReceivedWeights{part.version, part.env_steps, part.checkpoint, assembler_.Take()};
  if (on_newest_) on_newest_(*newest_);
  arrived_.NotifyAll();
}

std::optional<ReceivedWeights> WeightsInbox::TakeNewest() {
  return std::exchange(newest_, std::nullopt);
}

std::optional<ReceivedWeights> WeightsInbox::TryTake() {
  const MutexLock lock(mutex_);
  return TakeNewest();
}

std::optional<ReceivedWeights> WeightsInbox::Take(SteadyTime deadline) {
  const MutexLock lock(mutex_);
  while (!newest_ && arrived_.WaitUntil(mutex_, deadline)) {
  }
  return TakeNewest();
}

uint64_t WeightsInbox::overtaken() const {
  const MutexLock lock(mutex_);
  return overtaken_;
}

uint64_t WeightsInbox::refused() const {
  const MutexLock lock(mutex_);
  return refused_;
}

}  // namespace shoal::actor
