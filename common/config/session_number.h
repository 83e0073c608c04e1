// SPDX-License-Identifier: Apache-2.0
// The number of a process's session: wall-clock nanoseconds at the process's start, but always
// higher than the numbers of earlier sessions in the run. Peers treat the session with the higher
// number as newer. Therefore a restarted process must not get a lower number, even if the clock was
// set back.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace shoal {

// The next session of `process` ("actor-3"), stored in RUN/sessions/PROCESS. `wall_time_ns` is the
// present wall time. Throws Error (kUsage) if the file does not contain a number. The next number
// can be stored even if the disk is full. If the file cannot be written, logs a warning.
uint64_t NextSession(const std::filesystem::path& run, const std::string& process,
                     int64_t wall_time_ns);

}  // namespace shoal
