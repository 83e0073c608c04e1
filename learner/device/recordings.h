// SPDX-License-Identifier: Apache-2.0
// Recordings of the lists of commands that a device has run.
#pragma once

#include <deque>
#include <memory>

#include "learner/device/commands.h"
#include "learner/device/device.h"

namespace shoal::learner::device {

class Recordings {
 public:
  // Borrows the device.
  explicit Recordings(Device* device) : device_(device) {}

  // Replays the recording of the commands, after recording them if they are new.
  void Run(const CommandList& commands);
  int64_t recorded() const { return recorded_; }  // number of lists recorded so far

 private:
  struct Kept {
    CommandList commands;
    std::unique_ptr<Recording> recording;
  };

  Device* const device_;
  std::deque<Kept> kept_;  // newest use first
  int64_t recorded_ = 0;
};

}  // namespace shoal::learner::device
