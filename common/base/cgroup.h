// SPDX-License-Identifier: Apache-2.0
// The control groups (version 1 or 2) around this process, as folders of limits. Limits of all of
// them hold at once.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shoal {

struct CgroupFolder {
  std::filesystem::path path;
  int version = 2;  // 1 or 2: files of limits have other names
};

// Folders of the controller ("cpu", "memory") from the process's own group outwards to the mount.
// Where the process sees only its part of the hierarchy some are not there. Reads below `root` ("/"
// but for tests).
std::vector<CgroupFolder> CgroupFolders(const std::string& controller,
                                        const std::filesystem::path& root = "/");

}  // namespace shoal
