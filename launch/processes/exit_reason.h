// SPDX-License-Identifier: Apache-2.0
// The reason of a process's end, taken from its own output.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace shoal::launch {

// Reason of a process's end, from its output after the byte `from`: the last error, or the last
// line that is not of our log; else the last warning; else empty, as information in the log is no
// reason. Date, time and name of a log line are left out. At most the last 64 kB are read.
std::string ExitReason(const std::filesystem::path& output, uintmax_t from);

}  // namespace shoal::launch
