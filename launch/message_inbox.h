// Hands messages from a DDS receive thread to the coordinator's loop.
#pragma once

#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

namespace shoal::launch {

// Any thread may Put, any may take. Holds at most `capacity` messages; what comes beyond is dropped
// and counted.
template <class M>
class MessageInbox {
 public:
  explicit MessageInbox(size_t capacity) : capacity_(capacity) {}

  void Put(const M& message) {
    const std::lock_guard lock(mutex_);
    if (messages_.size() < capacity_) {
      messages_.push_back(message);
    } else {
      ++dropped_;
    }
  }

  std::vector<M> TakeAll() {
    const std::lock_guard lock(mutex_);
    return std::exchange(messages_, {});
  }

  uint64_t dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  const size_t capacity_;
  mutable std::mutex mutex_;
  std::vector<M> messages_;
  uint64_t dropped_ = 0;
};

}  // namespace shoal::launch
