// SPDX-License-Identifier: Apache-2.0
// Why an episode cannot go on: a number of the simulation is not finite. Training ends the episode
// and begins another; a bad policy or a mistake in a task is another kind of error.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "common/base/error.h"

namespace shoal::worlds {

enum class FaultCause {
  kDiverged,     // the simulation's state, or what a physics half itself reports as not finite
  kObservation,  // a number that World::Observe wrote
  kReward,       // a reward that the physics half returned
};
inline constexpr std::array kFaultCauses{FaultCause::kDiverged, FaultCause::kObservation,
                                         FaultCause::kReward};

// "diverged", "observation", "reward": as metrics and files have it.
constexpr std::string_view NameOf(FaultCause cause) {
  switch (cause) {
    case FaultCause::kDiverged:
      return "diverged";
    case FaultCause::kObservation:
      return "observation";
    case FaultCause::kReward:
      return "reward";
  }
  return "?";
}

// Its message is one line that names the task and the number. The exit code is that of numbers that
// are not finite.
class EpisodeFault : public Error {
 public:
  EpisodeFault(FaultCause cause, const std::string& message)
      : Error(ErrorKind::kNonFinite, message), cause_(cause) {}
  FaultCause cause() const { return cause_; }

 private:
  FaultCause cause_;
};

}  // namespace shoal::worlds
