// SPDX-License-Identifier: Apache-2.0
// When an expendable process is restarted. Unlike RestartPolicy it never gives up: it waits longer
// from death to death. Pure: the caller supplies the times.
#pragma once

#include <chrono>
#include <deque>

namespace shoal::launch {

struct BackoffLimits {
  std::chrono::milliseconds first_delay{200};  // doubles with each death within `window`
  std::chrono::milliseconds longest_delay{60'000};
  std::chrono::seconds window{60};    // of work, not of time: waiting for a restart is none
  std::chrono::seconds healthy{600};  // after so much work at a stretch deaths are counted anew
};

class RestartBackoff {
 public:
  struct Restart {
    std::chrono::milliseconds delay{};
    int deaths = 0;         // in a row, this one included
    bool announce = false;  // the first death and each doubling of their number
  };

  explicit RestartBackoff(const BackoffLimits& limits) : limits_(limits) {}

  // The process died after it had worked for `worked` (0: it never came to work).
  Restart OnDeath(std::chrono::milliseconds worked);

 private:
  BackoffLimits limits_;
  std::chrono::milliseconds work_{};              // of all its lives
  std::deque<std::chrono::milliseconds> recent_;  // deaths within the window: `work_` at each
  int deaths_ = 0;
};

}  // namespace shoal::launch
