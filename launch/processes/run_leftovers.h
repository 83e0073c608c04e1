// SPDX-License-Identifier: Apache-2.0
// Leftovers of a run whose processes were killed: processes that still store records, and
// unfinished files.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

namespace shoal::launch {

// Waits until no process works on the run any more (run_membership.h). If the coordinator was
// killed, actors and learner finish at once, and the replay finishes when the heartbeat has been
// missing for the lease. `say` gets a line if the function has to wait. Throws Error naming a
// process that still runs at the deadline or when `stop` returns true.
void WaitForFormerProcesses(const std::filesystem::path& run, std::chrono::seconds deadline,
                            const std::function<bool()>& stop,
                            const std::function<void(const std::string&)>& say);

// Deadline of this wait. Longer than the lease plus the shutdown of a replay whose coordinator
// died.
inline constexpr std::chrono::seconds kFormerProcessesDeadline{60};

// Removes unfinished files and folders of the run, which have temporary names. Call it only while
// no process works on the run. Returns the number of removed entries; a file that cannot be removed
// stays.
int RemoveUnfinishedFiles(const std::filesystem::path& run);

}  // namespace shoal::launch
