// SPDX-License-Identifier: Apache-2.0
// The number of a process's session: wall-clock nanoseconds at its start, but always above those of
// its predecessors in the run. Peers take the higher number for the newer process, so a clock that
// was set back must not make a restarted process look like an old one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace shoal {

// The next session of `process` ("actor-3"), stored in RUN/sessions/PROCESS. `wall_time_ns` is the
// time of the clock. Throws Error (usage) if the file is not a number. A disk that is full does not
// prevent that a successor's number is stored; a file that cannot be written gives a warning.
uint64_t NextSession(const std::filesystem::path& run, const std::string& process,
                     int64_t wall_time_ns);

}  // namespace shoal
