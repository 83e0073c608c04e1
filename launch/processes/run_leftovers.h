// SPDX-License-Identifier: Apache-2.0
// Leftovers of a run whose processes were killed: other processes that still store their records,
// and unfinished files.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

namespace shoal::launch {

// Waits until no process works on the run any more (run_membership.h): after the coordinator was
// killed, actors and learner finish at once, the replay when the heartbeat has been missing for the
// lease. `say` gets a line when there is something to wait for. Throws Error naming a process that
// is still there at the deadline, or when `stop` says so.
void WaitForFormerProcesses(const std::filesystem::path& run, std::chrono::seconds deadline,
                            const std::function<bool()>& stop,
                            const std::function<void(const std::string&)>& say);

// Longer than the lease and the farewell of a replay whose coordinator died.
inline constexpr std::chrono::seconds kFormerProcessesDeadline{60};

// Removes files and folders of the run that were being written under a temporary name. Only while
// no process works on the run. Returns how many; what cannot be removed stays.
int RemoveUnfinishedFiles(const std::filesystem::path& run);

}  // namespace shoal::launch
