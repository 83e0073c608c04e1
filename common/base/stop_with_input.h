// SPDX-License-Identifier: Apache-2.0
// Stops a process when whoever holds the other end of its standard input is gone. A remote shell
// closes it when its client dies, where no signal and no parent's death would be seen.
#pragma once

#include <thread>

#include "common/base/pipe.h"

namespace shoal {

// Reads standard input, and discards it, on a thread of its own; calls RequestStop (stop.h) at its
// end. One per process.
class StopWithInput {
 public:
  // Throws Error when the system gives no pipe.
  StopWithInput();
  ~StopWithInput();
  StopWithInput(const StopWithInput&) = delete;
  StopWithInput& operator=(const StopWithInput&) = delete;

 private:
  void Watch() const;

  Pipe wake_;  // closing its write end ends the thread
  std::thread thread_;
};

}  // namespace shoal
