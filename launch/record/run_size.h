// SPDX-License-Identifier: Apache-2.0
// How much room a run takes on the disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace shoal::launch {

struct RunSize {
  uint64_t total = 0;   // bytes on the disk, each file once, whatever the number of its names
  uint64_t replay = 0;  // of these in the replay's ring
};
// Files that cannot be read count as 0 bytes.
RunSize SizeOfRun(const std::filesystem::path& run);

// "2.1 GB", "13 MB", "0.4 MB"
std::string FormatBytes(uint64_t bytes);

}  // namespace shoal::launch
