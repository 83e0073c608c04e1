// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/restart_policy.h"

#include <algorithm>

namespace shoal::launch {

std::optional<std::chrono::milliseconds> RestartPolicy::OnDeath(SteadyTime now) {
  while (!deaths_.empty() && now - deaths_.front() > limits_.window) deaths_.pop_front();
  deaths_.push_back(now);
  const auto recent = static_cast<int>(deaths_.size());
  if (recent > limits_.restarts) return std::nullopt;
  std::chrono::milliseconds delay = limits_.first_delay;
  for (int i = 1; i < recent && delay < limits_.longest_delay; ++i) delay *= 2;
  return std::min(delay, limits_.longest_delay);
}

}  // namespace shoal::launch
