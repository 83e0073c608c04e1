#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "common/base/error.h"
#include "common/config/config_io.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;

// Where presets may lie, first match wins: beside the program, in its install prefix, in the source
// tree the program was built from.
std::vector<fs::path> PresetFolders() {
  std::vector<fs::path> folders;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    folders.push_back(program.parent_path() / "presets");
    folders.push_back(program.parent_path().parent_path() / "share/shoal/presets");
  }
  folders.emplace_back(SHOAL_SOURCE_PRESETS);
  return folders;
}

// Says of each folder why nothing was found there.
[[noreturn]] void FailWithoutPresets() {
  std::string reasons;
  for (const fs::path& folder : PresetFolders()) {
    std::error_code error;
    const fs::directory_iterator contents(folder, error);
    fmt::format_to(std::back_inserter(reasons), "{}{} ({})", reasons.empty() ? "" : ", ",
                   folder.string(), error ? error.message() : "holds none");
  }
  throw RuntimeError("found no presets; looked in {}", reasons);
}

}  // namespace

std::vector<std::string> ListPresets() {
  std::set<std::string> names;
  for (const fs::path& folder : PresetFolders()) {
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
      if (it->path().extension() == ".json") names.insert(it->path().stem());
    }
  }
  return {names.begin(), names.end()};
}

std::string FindPreset(const std::string& name) {
  const std::vector<std::string> known = ListPresets();
  if (known.empty()) FailWithoutPresets();
  // Only listed names: a name with '/' must not reach outside the folders.
  if (std::ranges::find(known, name) != known.end()) {
    for (const fs::path& folder : PresetFolders()) {
      std::error_code error;
      const fs::path path = folder / (name + ".json");
      if (fs::is_regular_file(path, error)) return path;
    }
  }
  throw UsageError("unknown preset '{}', there are: {}", name, fmt::join(known, ", "));
}

Config LoadPreset(const std::string& name) {
  Config config;
  ApplyFile(FindPreset(name), &config);
  config.preset = name;
  return config;
}

}  // namespace shoal
