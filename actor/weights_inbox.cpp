#include "actor/weights_inbox.h"

#include <utility>

#include "common/base/crc32.h"

namespace shoal::actor {

void WeightsInbox::OnMessage(const WeightsMessage& message) {
  const MutexLock lock(mutex_);
  if (message.spec_hash != spec_hash_ || Crc32(message.payload) != message.crc) {
    ++refused_;
    return;
  }
  const WeightsVersion& known = newest_ ? newest_->version : taken_;
  if (!message.version.NewerThan(known)) return;
  if (newest_) ++overtaken_;
  newest_ = ReceivedWeights{
      message.version, message.env_steps, message.checkpoint,
      std::string(reinterpret_cast<const char*>(message.payload.data()), message.payload.size())};
  arrived_.NotifyAll();
}

std::optional<ReceivedWeights> WeightsInbox::TakeNewest() {
  if (newest_) taken_ = newest_->version;
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
