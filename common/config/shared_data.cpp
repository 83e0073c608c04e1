// SPDX-License-Identifier: Apache-2.0
#include "common/config/shared_data.h"

#include <fmt/ranges.h>

#include <set>

#include "common/base/error.h"
#include "common/base/program_file.h"

namespace shoal {

namespace fs = std::filesystem;

std::vector<fs::path> SharedDataFolders(const std::string& kind) {
  std::vector<fs::path> folders;
  std::error_code error;
  if (fs::is_regular_file(kProjectFile, error)) folders.push_back(fs::path(kind));
  const fs::path program = ProgramFile();
  folders.push_back(program.parent_path() / kind);
  folders.push_back(program.parent_path().parent_path() / "share/shoal" / kind);
  return folders;
}

std::vector<std::string> ListSharedData(const std::string& kind) {
  std::set<std::string> names;
  for (const fs::path& folder : SharedDataFolders(kind)) {
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
      if (it->path().extension() == ".json") names.insert(it->path().stem());
    }
  }
  return {names.begin(), names.end()};
}

std::optional<fs::path> FindSharedData(const std::string& kind, const std::string& name) {
  if (name.empty() || name.find('/') != std::string::npos) return std::nullopt;
  for (const fs::path& folder : SharedDataFolders(kind)) {
    std::error_code error;
    fs::path path = folder / (name + ".json");
    if (fs::is_regular_file(path, error)) return path;
  }
  return std::nullopt;
}

fs::path FindFileOrSharedData(const std::string& kind, const std::string& noun,
                              const std::string& file_or_name) {
  const bool is_file =
      file_or_name.find('/') != std::string::npos || fs::path(file_or_name).extension() == ".json";
  if (is_file) return file_or_name;
  if (const auto path = FindSharedData(kind, file_or_name)) return *path;
  throw UsageError("no {} '{}': expected a file (*.json) or one of: {}", noun, file_or_name,
                   fmt::join(ListSharedData(kind), ", "));
}

}  // namespace shoal
