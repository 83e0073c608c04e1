// SPDX-License-Identifier: Apache-2.0
#include "common/link/sample_queue.h"

namespace shoal::link {

SharedSample SampleQueue::Push(SharedSample sample) {
  samples_.push_back(std::move(sample));
  if (keep_last_ == 0) return nullptr;
  std::deque<Samples::iterator>& places = places_[Of(*samples_.back())];
  places.push_back(std::prev(samples_.end()));
  if (places.size() <= static_cast<size_t>(keep_last_)) return nullptr;
  SharedSample pushed_out = std::move(*places.front());
  samples_.erase(places.front());
  places.pop_front();
  return pushed_out;
}

SharedSample SampleQueue::Pop() {
  if (samples_.empty()) return nullptr;
  SharedSample sample = std::move(samples_.front());
  samples_.pop_front();
  if (keep_last_ > 0) {
    // The oldest sample of all is also the oldest of its writer and key.
    const auto places = places_.find(Of(*sample));
    places->second.pop_front();
    if (places->second.empty()) places_.erase(places);
  }
  return sample;
}

std::list<SharedSample> SampleQueue::TakeAll() {
  places_.clear();
  return std::exchange(samples_, {});
}

}  // namespace shoal::link
