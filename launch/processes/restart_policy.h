// SPDX-License-Identifier: Apache-2.0
// Decides whether and when a process that died is started again. Pure: the caller supplies the
// time.
#pragma once

#include <chrono>
#include <deque>
#include <optional>

#include "common/base/clock.h"

namespace shoal::launch {

struct RestartLimits {
  int restarts = 5;  // allowed within `window`; one more death fails the run
  std::chrono::seconds window{60};
  std::chrono::milliseconds first_delay{200};  // doubles with each death within the window
  std::chrono::milliseconds longest_delay{5000};
};

class RestartPolicy {
 public:
  explicit RestartPolicy(const RestartLimits& limits) : limits_(limits) {}

  // The process died at `now`. Returns the delay before the next start; empty if the process died
  // too often.
  std::optional<std::chrono::milliseconds> OnDeath(SteadyTime now);

 private:
  RestartLimits limits_;
  std::deque<SteadyTime> deaths_;  // within the window
};

}  // namespace shoal::launch
