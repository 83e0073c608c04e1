// SPDX-License-Identifier: Apache-2.0
// The parts of the page: files built into the program, and the chart library.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace shoal::launch {

// The folder of dygraphs: in the bundle or prefix of the program, or, if dygraphs is not there, in
// Debian's package libjs-dygraphs.
std::filesystem::path ChartLibrary();

struct PagePart {
  std::string type;  // MIME
  std::string content;
};

// The parts by name: "index.html", "page.js", "dygraph.min.js", ... Reads the chart library from
// its folder. If a file is missing, throws Error naming the file and its package.
std::map<std::string, PagePart> LoadPageParts(
    const std::filesystem::path& chart_library = ChartLibrary());

}  // namespace shoal::launch
