// SPDX-License-Identifier: Apache-2.0
#include "learner/device/recordings.h"

#include <algorithm>

namespace shoal::learner::device {
namespace {

// Kinds of updates, twice because two landings take turns. An algorithm has a few kinds.
constexpr size_t kMost = 32;

}  // namespace

void Recordings::Run(const CommandList& commands) {
  const auto found = std::ranges::find(kept_, commands, &Kept::commands);
  if (found == kept_.end()) {
    if (kept_.size() == kMost) {
      device_->Finish();  // a recording is not destroyed while it runs
      kept_.pop_back();
    }
    kept_.push_front({commands, device_->Record(commands)});
    ++recorded_;
  } else {
    std::rotate(kept_.begin(), found, found + 1);
  }
  device_->Replay(*kept_.front().recording);
}

}  // namespace shoal::learner::device
