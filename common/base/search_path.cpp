// SPDX-License-Identifier: Apache-2.0
#include "common/base/search_path.h"

#include <unistd.h>

#include <cstdlib>
#include <sstream>
#include <system_error>

namespace shoal {

namespace fs = std::filesystem;

bool IsExecutable(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && access(path.c_str(), X_OK) == 0;
}

std::optional<fs::path> FindOnSearchPath(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path file = fs::path(folder.empty() ? "." : folder) / program;
    if (IsExecutable(file)) return file;
  }
  return std::nullopt;
}

}  // namespace shoal
