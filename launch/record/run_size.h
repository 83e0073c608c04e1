// SPDX-License-Identifier: Apache-2.0
// The size of a run on the disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace shoal::launch {

struct RunSize {
  uint64_t total = 0;   // bytes on the disk; hard-linked files count once
  uint64_t replay = 0;  // bytes of the replay's ring; included in `total`
};
// Files that cannot be read count as 0 bytes.
RunSize SizeOfRun(const std::filesystem::path& run);

// "2.1 GB", "13 MB", "0.4 MB"
std::string FormatBytes(uint64_t bytes);

}  // namespace shoal::launch
