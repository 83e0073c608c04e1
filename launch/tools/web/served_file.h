// SPDX-License-Identifier: Apache-2.0
// Files of a run's folder that the page serves: films, reports and pictures of the kinds below. No
// other files are served.
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

// `path`: relative to the run's folder, with slashes. Empty if the path has none of the forms
// above, does not exist, is not a regular file, or contains a link below the run's folder.
std::optional<ServedFile> OpenServedFile(const std::filesystem::path& run, std::string_view path);

// Opens a file that Shoal made, at any path and of any form. Otherwise like OpenServedFile.
std::optional<ServedFile> OpenWholeFile(const std::filesystem::path& file, const char* type);

struct ServedName {
  std::string path;  // for OpenServedFile
  uint64_t bytes = 0;
  double modified = 0;  // seconds since 1970
};

// The existing files of the forms above, the newest first; at most 200.
std::vector<ServedName> ListServedFiles(const std::filesystem::path& run);

}  // namespace shoal::launch
