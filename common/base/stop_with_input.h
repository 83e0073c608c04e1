// SPDX-License-Identifier: Apache-2.0
// Stops a process at the end of its standard input. A remote shell closes that input when its
// client dies; neither a signal nor the death of a parent would show it.
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
