// SPDX-License-Identifier: Apache-2.0
// Checks whether there is enough space for the ring. The check runs once, at the start of the
// server. Without the check, a full disk under a mapping would later raise SIGBUS, and a full
// cgroup SIGKILL.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace shoal::replay {

struct MemoryRoom {
  uint64_t bytes = 0;
  std::string source;  // name of the limit: "MemAvailable" or a cgroup file
};

// The smallest of the machine's available memory and the memory that is free in each cgroup (v1 or
// v2) of this process. Reclaimable file cache counts as free. Reads files below `root` ("/" except
// in tests).
MemoryRoom AvailableMemory(const std::filesystem::path& root = "/");

// If fewer than `bytes` bytes of memory are available, throws Error that contains the two numbers
// and the remedies: a smaller ring, and `remedy`. `root`: as for AvailableMemory.
void CheckMemoryRoom(uint64_t bytes, std::string_view remedy = "set replay.storage=file",
                     const std::filesystem::path& root = "/");
// Checks whether a file of `bytes` fits in `folder`: the limit for file sizes, the free space of
// the file system and, if the file system is in memory, the memory. Throws Error like
// CheckMemoryRoom.
void CheckDiskRoom(const std::filesystem::path& folder, uint64_t bytes);

}  // namespace shoal::replay
