// SPDX-License-Identifier: Apache-2.0
// Hands messages from a DDS receive thread to the coordinator's loop.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "common/base/mutex.h"

namespace shoal::launch {

// Any thread may call each method. Holds at most `capacity` messages; further messages are dropped
// and counted.
template <class M>
class MessageInbox {
 public:
  explicit MessageInbox(size_t capacity) : capacity_(capacity) {}

  void Put(const M& message) {
    const MutexLock lock(mutex_);
    if (messages_.size() < capacity_) {
      messages_.push_back(message);
    } else {
      ++dropped_;
    }
  }

  std::vector<M> TakeAll() {
    const MutexLock lock(mutex_);
    return std::exchange(messages_, {});
  }

  uint64_t dropped() const {
    const MutexLock lock(mutex_);
    return dropped_;
  }

 private:
  const size_t capacity_;
  mutable Mutex mutex_;
  std::vector<M> messages_ SHOAL_GUARDED_BY(mutex_);
  uint64_t dropped_ SHOAL_GUARDED_BY(mutex_) = 0;
};

}  // namespace shoal::launch
