// SPDX-License-Identifier: Apache-2.0
// Decides when an expendable process is restarted. Unlike RestartPolicy, the backoff never gives
// up: the delay grows with each death. Pure: the caller supplies the times.
#pragma once

#include <chrono>
#include <deque>

namespace shoal::launch {

struct BackoffLimits {
  std::chrono::milliseconds first_delay{200};  // doubles with each death within `window`
  std::chrono::milliseconds longest_delay{60'000};
  std::chrono::seconds window{60};    // of working time; waiting for a restart does not count
  std::chrono::seconds healthy{600};  // uninterrupted work that resets the count
};

class RestartBackoff {
 public:
  struct Restart {
    std::chrono::milliseconds delay{};
    int deaths = 0;         // in a row, this one included
    bool announce = false;  // the first death and each doubling of their number
  };

  explicit RestartBackoff(const BackoffLimits& limits) : limits_(limits) {}

  // The process died after it had worked for `worked` (0: it died before it worked).
  Restart OnDeath(std::chrono::milliseconds worked);

 private:
  BackoffLimits limits_;
  std::chrono::milliseconds work_{};              // working time of all its sessions
  std::deque<std::chrono::milliseconds> recent_;  // deaths within the window: `work_` at each
  int deaths_ = 0;
};

}  // namespace shoal::launch
