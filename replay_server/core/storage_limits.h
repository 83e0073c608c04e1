// SPDX-License-Identifier: Apache-2.0
// Checks whether there is room for the ring. The check runs once at start: later a full disk under
// a mapping raises SIGBUS, and a full cgroup SIGKILL.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace shoal::replay {

struct MemoryRoom {
  uint64_t bytes = 0;
  std::string source;  // the limit: "MemAvailable" or a cgroup file
};

// The smaller of the machine's available memory and the memory that each cgroup (v1 or v2) of this
// process leaves. Reclaimable file cache counts as free. Reads files below `root` ("/" except in
// tests).
MemoryRoom AvailableMemory(const std::filesystem::path& root = "/");

// Throws Error naming the bytes needed, the bytes available and the remedies: a smaller ring and
// `remedy`. `root`: as for AvailableMemory.
void CheckMemoryRoom(uint64_t bytes, std::string_view remedy = "set replay.storage=file",
                     const std::filesystem::path& root = "/");
// Checks the room for a file of `bytes` in `folder`: the file size limit, the free space of the
// file system, and memory if the file system is in memory. Throws Error like CheckMemoryRoom.
void CheckDiskRoom(const std::filesystem::path& folder, uint64_t bytes);

}  // namespace shoal::replay
