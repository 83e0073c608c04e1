// SPDX-License-Identifier: Apache-2.0
// The page itself: what is built into the program, and the library that draws its curves.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace shoal::launch {

// The folder of dygraphs: that of the bundle or prefix that the program belongs to, else that of
// Debian's package libjs-dygraphs.
std::filesystem::path ChartLibrary();

struct PagePart {
  std::string type;  // MIME
  std::string content;
};

// By name: "index.html", "page.js", "dygraph.min.js", ... Reads the chart library from its folder.
// Throws Error naming the file that is missing, and its package.
std::map<std::string, PagePart> LoadPageParts(
    const std::filesystem::path& chart_library = ChartLibrary());

}  // namespace shoal::launch
