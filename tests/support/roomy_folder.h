// SPDX-License-Identifier: Apache-2.0
// A folder for runs of whole presets: before a run starts, its disk must have room for a full
// replay, although a test writes little of it.
#pragma once

#include <filesystem>
#include <system_error>

namespace shoal {

// Returns the folder for temporary files if its disk has room for a run of any preset. Otherwise
// returns the one with the most free space among this folder, /var/tmp and /dev/shm.
inline std::filesystem::path RoomyFolder() {
  namespace fs = std::filesystem;
  constexpr uintmax_t kEnough = 16'000'000'000;
  const auto free_bytes = [](const fs::path& folder) -> uintmax_t {
    std::error_code error;
    const fs::space_info space = fs::space(folder, error);
    return error ? 0 : space.available;
  };
  fs::path roomiest = fs::temp_directory_path();
  if (free_bytes(roomiest) >= kEnough) return roomiest;
  for (const char* folder : {"/var/tmp", "/dev/shm"}) {
    if (free_bytes(folder) > free_bytes(roomiest)) roomiest = folder;
  }
  return roomiest;
}

}  // namespace shoal
