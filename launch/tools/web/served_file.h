// SPDX-License-Identifier: Apache-2.0
// The files of a run's folder that the page hands out: films, reports and pictures, by their kinds;
// nothing else of the folder, and nothing outside of it.
//
//   videos/NAME.mp4    NAME.html    NAME.svg    NAME.png    plots/NAME.svg    plots/NAME.png
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/descriptor.h"

namespace shoal::launch {

struct ServedFile {
  Descriptor file;  // open for reading
  uint64_t bytes = 0;
  const char* type = "";  // MIME
};

// `path`: below the run's folder, with slashes. Empty where it is of no kind above, not there, no
// plain file, or a link anywhere below the run's folder leads to it.
std::optional<ServedFile> OpenServedFile(const std::filesystem::path& run, std::string_view path);

// A file of our own, wherever it is; the same otherwise.
std::optional<ServedFile> OpenWholeFile(const std::filesystem::path& file, const char* type);

struct ServedName {
  std::string path;  // for OpenServedFile
  uint64_t bytes = 0;
  double modified = 0;  // seconds since 1970
};

// Those there are, the newest first; at most 200.
std::vector<ServedName> ListServedFiles(const std::filesystem::path& run);

}  // namespace shoal::launch
