#include "actor/weights_inbox.h"

#include <utility>

#include "common/base/crc32.h"

namespace shoal::actor {

void WeightsInbox::OnMessage(const WeightsMessage& message) {
  const std::lock_guard lock(mutex_);
  if (message.spec_hash != spec_hash_ || Crc32(message.payload) != message.crc) {
    ++refused_;
    return;
  }
  const WeightsVersion& known = newest_ ? newest_->version : taken_;
  if (!message.version.NewerThan(known)) return;
  newest_ = ReceivedWeights{
      message.version, message.env_steps, message.checkpoint,
      std::string(reinterpret_cast<const char*>(message.payload.data()), message.payload.size())};
  arrived_.notify_all();
}

std::optional<ReceivedWeights> WeightsInbox::TryTake() {
  const std::lock_guard lock(mutex_);
  if (!newest_) return std::nullopt;
  taken_ = newest_->version;
  return std::exchange(newest_, std::nullopt);
}

std::optional<ReceivedWeights> WeightsInbox::Take(SteadyTime deadline) {
  {
    std::unique_lock lock(mutex_);
    if (!arrived_.wait_until(lock, deadline, [&] { return newest_.has_value(); })) {
      return std::nullopt;
    }
  }
  return TryTake();
}

uint64_t WeightsInbox::refused() const {
  const std::lock_guard lock(mutex_);
  return refused_;
}

}  // namespace shoal::actor
