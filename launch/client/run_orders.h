// SPDX-License-Identifier: Apache-2.0
// Orders to a running run, and the wait for their effects: shoal set, scale, stop.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "launch/client/run_client.h"

namespace shoal::launch {

// Deadlines of the wait, which begins after the coordinator has accepted the order
// (RunClient::kAnswer).
inline constexpr std::chrono::seconds kInForce{10};    // for processes to use a changed value
inline constexpr std::chrono::seconds kScaled{60};     // for actors to start or to stop
inline constexpr std::chrono::seconds kStopped{3600};  // for a run in its last evaluation
inline constexpr std::chrono::seconds kLeaves{10};  // for a coordinator to exit after its last view
// If no view arrives for this time, the coordinator is treated as dead. The run's processes use the
// same timeout.
inline constexpr std::chrono::seconds kCoordinatorSilence{15};

// Gets each line that the command prints.
using Say = std::function<void(const std::string& line)>;

// Each function sends its order, waits for the effect and returns the command's exit code. A stop
// signal ends the wait but does not cancel the order. The functions throw Error if the order was
// refused or not answered, if the coordinator is silent, or if the effect is not seen in time.
//
// Returns when every process that uses a changed value reports the new value.
int SetKeys(RunClient& client, const std::vector<std::string>& assignments, const Say& say);
// Returns when `actors` actors report.
int ScaleActors(RunClient& client, int actors, const Say& say);
// Returns the run's exit code when the run has ended and no process holds `folder`. With an empty
// `folder`, does not check the second condition.
int StopRun(RunClient& client, const std::filesystem::path& folder, const Say& say);

}  // namespace shoal::launch
