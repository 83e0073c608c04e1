// SPDX-License-Identifier: Apache-2.0
#include "common/base/cgroup.h"

#include <fmt/core.h>

#include <fstream>

namespace shoal {
namespace {

namespace fs = std::filesystem;

void AddGroup(const fs::path& mount, fs::path group, int version,
              std::vector<CgroupFolder>* folders) {
  while (true) {
    folders->push_back({mount / group.relative_path(), version});
    if (!group.has_relative_path()) return;
    group = group.parent_path();
  }
}

}  // namespace

std::vector<CgroupFolder> CgroupFolders(const std::string& controller, const fs::path& root) {
  const fs::path mount = root / "sys/fs/cgroup";
  std::vector<CgroupFolder> folders;
  std::ifstream groups(root / "proc/self/cgroup");
  std::string line;  // "HIERARCHY:CONTROLLERS:PATH"; version 2 has no controllers
  while (std::getline(groups, line)) {
    const size_t first = line.find(':');
    const size_t second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = fmt::format(",{},", line.substr(first + 1, second - first - 1));
    const std::string group = line.substr(second + 1);
    if (controllers == ",,") AddGroup(mount, group, 2, &folders);
    if (controllers.find(fmt::format(",{},", controller)) != std::string::npos) {
      AddGroup(mount / controller, group, 1, &folders);
    }
  }
  return folders;
}

}  // namespace shoal
