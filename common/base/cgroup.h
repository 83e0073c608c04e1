// SPDX-License-Identifier: Apache-2.0
// The control groups (version 1 or 2) that contain this process, as folders of limits. The limits
// of all these groups apply together.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shoal {

struct CgroupFolder {
  std::filesystem::path path;
  int version = 2;  // 1 or 2: files of limits have other names
};

// Folders of the controller ("cpu", "memory"), from the process's own group outwards to the mount.
// If the process sees only a part of the hierarchy, some of these folders do not exist. Reads below
// `root`, which is "/" except in tests.
std::vector<CgroupFolder> CgroupFolders(const std::string& controller,
                                        const std::filesystem::path& root = "/");

}  // namespace shoal
