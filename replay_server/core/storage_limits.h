// SPDX-License-Identifier: Apache-2.0
// Is there room for the ring? Asked once at start, because afterwards it is too late: a full disk
// under a mapping is a SIGBUS, a full cgroup a SIGKILL.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace shoal::replay {

struct MemoryRoom {
  uint64_t bytes = 0;
  std::string source;  // what limits it: "MemAvailable" or a cgroup file
};

// The least of the machine's available memory and what each cgroup (v1 or v2) around this process
// leaves; reclaimable file cache counts as free. Reads below `root` ("/" but for tests).
MemoryRoom AvailableMemory(const std::filesystem::path& root = "/");

// Throw Error naming the bytes needed and there, and what to change; `remedy` is one that the
// caller knows beside a smaller ring, `root` as above.
void CheckMemoryRoom(uint64_t bytes, std::string_view remedy = "set replay.storage=file",
                     const std::filesystem::path& root = "/");
// `folder` will hold a file of `bytes`. Checks the file size limit, the file system's free space,
// and memory where the file system lives in memory.
void CheckDiskRoom(const std::filesystem::path& folder, uint64_t bytes);

}  // namespace shoal::replay
