// SPDX-License-Identifier: Apache-2.0
// Finds the reason of a process's end in the output of the process.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace shoal::launch {

// Reads the output of a process after the byte `from`, but at most the last 64 kB. Returns the last
// line that is an error or is not in Shoal's log format. If there is no such line, returns the last
// warning, or an empty text. Date, time and name of a log line are left out.
std::string ExitReason(const std::filesystem::path& output, uintmax_t from);

}  // namespace shoal::launch
