// SPDX-License-Identifier: Apache-2.0
// Finds the reason of a process's end in the output of the process.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace shoal::launch {

// Reads the output of a process after the byte `from`. Returns the last error or the last line that
// is not in Shoal's log format; else the last warning; else an empty text. Date, time and name of a
// log line are left out. At most the last 64 kB are read.
std::string ExitReason(const std::filesystem::path& output, uintmax_t from);

}  // namespace shoal::launch
