// SPDX-License-Identifier: Apache-2.0
// Why a process ended, as far as its own output says so.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace shoal::launch {

// Of what was written from the byte `from` on: the last error, or the last line that is none of our
// log's; else the last warning. What the log only tells is no reason: empty. Date, time and name of
// a log line are left out. At most the last 64 kB are looked at.
std::string ExitReason(const std::filesystem::path& output, uintmax_t from);

}  // namespace shoal::launch
