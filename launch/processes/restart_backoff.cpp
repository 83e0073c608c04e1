// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/restart_backoff.h"

#include <algorithm>
#include <bit>

namespace shoal::launch {

RestartBackoff::Restart RestartBackoff::OnDeath(std::chrono::milliseconds worked) {
  constexpr size_t kEnough = 32;  // the delay doubles with each death
  work_ += worked;
  while (!recent_.empty() && work_ - recent_.front() > limits_.window) recent_.pop_front();
  recent_.push_back(work_);
  if (recent_.size() > kEnough) recent_.pop_front();
  deaths_ = worked >= limits_.healthy ? 1 : deaths_ + 1;
  std::chrono::milliseconds delay = limits_.first_delay;
  for (size_t i = 1; i < recent_.size() && delay < limits_.longest_delay; ++i) delay *= 2;
  return {.delay = std::min(delay, limits_.longest_delay),
          .deaths = deaths_,
          .announce = std::has_single_bit(static_cast<unsigned>(deaths_))};
}

}  // namespace shoal::launch
