// SPDX-License-Identifier: Apache-2.0
// The number of a process's session: wall-clock nanoseconds at its start, but always above the
// numbers of its predecessors in the run. Peers treat the process with the higher number as newer.
// After the clock was set back, a restarted process must therefore not get a lower number.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace shoal {

// The next session of `process` ("actor-3"), stored in RUN/sessions/PROCESS. `wall_time_ns` is the
// present wall time. Throws Error (usage) if the file does not hold a number. The next number can
// be stored even if the disk is full. If the file cannot be written, logs a warning.
uint64_t NextSession(const std::filesystem::path& run, const std::string& process,
                     int64_t wall_time_ns);

}  // namespace shoal
