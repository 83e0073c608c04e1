// SPDX-License-Identifier: Apache-2.0
// Stops a process at the end of its standard input. If the client of a remote shell dies, the shell
// closes the process's input, but the process receives no signal and its parent stays alive. The
// process can therefore detect the death only by the end of its input.
#pragma once

#include <thread>

#include "common/base/pipe.h"

namespace shoal {

// Reads and discards standard input on its own thread, and calls RequestStop (stop.h) at the end of
// the input. A process has at most one such object.
class StopWithInput {
 public:
  // Throws Error if the system cannot create a pipe.
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
