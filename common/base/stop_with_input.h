// SPDX-License-Identifier: Apache-2.0
// Stops a process at the end of its standard input. If the client of a remote shell dies, the shell
// closes the process's input. The process receives no signal then, and its parent stays alive.
#pragma once

#include <thread>

#include "common/base/pipe.h"

namespace shoal {

// Reads and discards standard input on its own thread, and calls RequestStop (stop.h) at the end of
// the input. One per process.
class StopWithInput {
 public:
  // Throws Error when the system cannot create a pipe.
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
