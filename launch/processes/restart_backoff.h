// SPDX-License-Identifier: Apache-2.0
// Decides when an expendable process is restarted. Unlike RestartPolicy, the backoff restarts
// without limit; the delay grows with each death. Pure: the caller supplies the times.
#pragma once

#include <chrono>
#include <deque>

namespace shoal::launch {

struct BackoffLimits {
  std::chrono::milliseconds first_delay{200};  // doubles with each death within `window`
  std::chrono::milliseconds longest_delay{60'000};
  std::chrono::seconds window{60};    // working time; the wait for a restart does not count
  std::chrono::seconds healthy{600};  // uninterrupted work that resets the count
};

class RestartBackoff {
 public:
  struct Restart {
    std::chrono::milliseconds delay{};
    int deaths = 0;         // consecutive deaths, this death included
    bool announce = false;  // true at the first death and whenever the number of deaths doubles
  };

  explicit RestartBackoff(const BackoffLimits& limits) : limits_(limits) {}

  // Call after a death. `worked`: working time of the process in its last session; 0 = it never
  // worked.
  Restart OnDeath(std::chrono::milliseconds worked);

 private:
  BackoffLimits limits_;
  std::chrono::milliseconds work_{};              // working time of all sessions of the process
  std::deque<std::chrono::milliseconds> recent_;  // value of `work_` at each death in the window
  int deaths_ = 0;
};

}  // namespace shoal::launch
