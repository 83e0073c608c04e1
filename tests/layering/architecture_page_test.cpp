// SPDX-License-Identifier: Apache-2.0
// Files and rooms of docs/architecture.md exist.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "tests/support/paths.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;

std::string Page(const fs::path& root) {
  std::ifstream in(root / "docs/architecture.md");
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

bool HasSources(const fs::path& folder) {
  return std::ranges::any_of(fs::recursive_directory_iterator(folder), [](const auto& entry) {
    return entry.path().extension() == ".cpp" || entry.path().extension() == ".h";
  });
}

// Everything between backticks that is a path of a source: folders and a file's name.
std::set<std::string> PathsIn(const std::string& page) {
  static const std::regex path("`([a-z_0-9]+(?:/[a-z_0-9]+)+\\.(?:h|cpp))`");
  std::set<std::string> paths;
  for (std::sregex_iterator it(page.begin(), page.end(), path), end; it != end; ++it) {
    paths.insert((*it)[1]);
  }
  return paths;
}

TEST(ArchitecturePage, EveryFileThatItNamesIsThere) {
  const fs::path root = SourcePath("");
  const std::set<std::string> paths = PathsIn(Page(root));
  EXPECT_GE(paths.size(), 20u) << "are they still written in backticks?";
  for (const std::string& path : paths) {
    // Paths of commands are relative to launch.
    EXPECT_TRUE(fs::exists(root / path) || fs::exists(root / "launch" / path)) << path;
  }
}

TEST(ArchitecturePage, EveryRoomHasItsLine) {
  const fs::path root = SourcePath("");
  const std::string page = Page(root);
  for (const std::string top :
       {"common", "actor", "replay_server", "learner", "launch", "launch/tools"}) {
    for (const auto& entry : fs::directory_iterator(root / top)) {
      const std::string name = entry.path().filename();
      if (top + "/" + name == "launch/tools") continue;  // a floor: its rooms have lines
      if (!entry.is_directory() || !HasSources(entry.path())) continue;
      EXPECT_NE(page.find("`" + top + "/" + name + "`"), std::string::npos) << top << "/" << name;
    }
  }
}

}  // namespace
}  // namespace shoal
