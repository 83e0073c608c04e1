// SPDX-License-Identifier: Apache-2.0
// Fault of an episode: a number of the simulation is not finite. Training ends the episode and
// begins another episode.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "common/base/error.h"

namespace shoal::worlds {

enum class FaultCause {
  kDiverged,     // the simulation's state is not finite, or the physics half itself reports a fault
  kObservation,  // a number that World::Observe wrote
  kReward,       // a reward that the physics half returned
};
inline constexpr std::array kFaultCauses{FaultCause::kDiverged, FaultCause::kObservation,
                                         FaultCause::kReward};

// Name of a cause in metrics and files: "diverged", "observation", "reward".
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

// The error of a faulty episode. The message is one line that names the task and the number. The
// exit code is that of ErrorKind::kNonFinite.
class EpisodeFault : public Error {
 public:
  EpisodeFault(FaultCause cause, const std::string& message)
      : Error(ErrorKind::kNonFinite, message), cause_(cause) {}
  FaultCause cause() const { return cause_; }

 private:
  FaultCause cause_;
};

}  // namespace shoal::worlds
