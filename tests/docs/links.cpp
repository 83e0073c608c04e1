// SPDX-License-Identifier: Apache-2.0
#include "tests/docs/links.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

namespace shoal {
namespace {

namespace fs = std::filesystem;

}  // namespace

std::vector<std::string> LinkFaults(const fs::path& root, const std::vector<Page>& pages) {
  std::map<std::string, std::vector<std::string>> anchors;  // by page
  for (const Page& page : pages) anchors[page.file] = AnchorsOf(page);
  std::vector<std::string> faults;
  for (const Page& page : pages) {
    for (const auto& [line, target] : page.links) {
      if (target.find("://") != std::string::npos) continue;
      const std::string path = target.substr(0, target.find('#'));
      const std::string file =
          path.empty() ? page.file
                       : (fs::path(page.file).parent_path() / path).lexically_normal().string();
      if (!fs::exists(root / file)) {
        faults.push_back(fmt::format("{}:{}: no '{}'", page.file, line, target));
      } else if (path.size() != target.size()) {
        const std::string anchor = target.substr(path.size() + 1);
        if (std::ranges::find(anchors[file], anchor) != anchors[file].end()) continue;
        faults.push_back(
            fmt::format("{}:{}: {} has no heading '#{}'", page.file, line, file, anchor));
      }
    }
  }
  return faults;
}

}  // namespace shoal
