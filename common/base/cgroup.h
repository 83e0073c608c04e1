// SPDX-License-Identifier: Apache-2.0
// Finds the folders of the control groups (version 1 or 2) that contain this process. Each folder
// has files with limits. The limits of all these groups apply together.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shoal {

struct CgroupFolder {
  std::filesystem::path path;
  int version = 2;  // 1 or 2; the names of the files depend on the version
};

// Returns the folders for `controller` ("cpu", "memory"), from the process's own group up to the
// mount point. If the process sees only a part of the hierarchy, some of these folders do not
// exist. Reads files below `root`, which is "/" except in tests.
std::vector<CgroupFolder> CgroupFolders(const std::string& controller,
                                        const std::filesystem::path& root = "/");

}  // namespace shoal
