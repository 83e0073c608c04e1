// SPDX-License-Identifier: Apache-2.0
#include <fmt/ranges.h>

#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/nearest_name.h"
#include "common/config/config_io.h"
#include "common/config/shared_data.h"

namespace shoal {
namespace {

constexpr char kKind[] = "presets";

// Says for each folder why no preset was found there.
[[noreturn]] void FailWithoutPresets() {
  std::string reasons;
  for (const std::filesystem::path& folder : SharedDataFolders(kKind)) {
    std::error_code error;
    const std::filesystem::directory_iterator contents(folder, error);
    fmt::format_to(std::back_inserter(reasons), "{}{} ({})", reasons.empty() ? "" : ", ",
                   folder.string(), error ? error.message() : "holds none");
  }
  throw RuntimeError("found no presets; looked in {}", reasons);
}

}  // namespace

std::vector<std::string> ListPresets() { return ListSharedData(kKind); }

std::string FindPreset(const std::string& name) {
  if (const auto path = FindSharedData(kKind, name)) return *path;
  const std::vector<std::string> known = ListPresets();
  if (known.empty()) FailWithoutPresets();
  throw UsageError("unknown preset '{}', there are: {}{}", name, fmt::join(known, ", "),
                   NearestHint(name, known));
}

Config LoadPreset(const std::string& name) {
  Config config;
  ApplyFile(FindPreset(name), &config);
  config.preset = name;
  return config;
}

}  // namespace shoal
