// SPDX-License-Identifier: Apache-2.0
// CMakeLists.txt, changelog, pages, packages and wheel must have the same version.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <string>

#include "common/base/build_info.h"
#include "common/base/files.h"
#include "tests/support/paths.h"

namespace shoal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// The matches of the first group of `pattern` in a text, each once.
std::set<std::string> Found(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::set<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it) {
    found.insert(it->str(1));
  }
  return found;
}

TEST(Version, TheNewestReleaseOfTheChangelogIsThatOfThePrograms) {
  std::smatch release;
  const std::string text = ReadFile(SourcePath("CHANGELOG.md"));
  ASSERT_TRUE(std::regex_search(text, release, std::regex(R"(\n## (\d[^\s]*))")));
  EXPECT_EQ(release.str(1), BuildVersion());
}

// File names of packages, wheels and bundles.
TEST(Version, PagesNameFilesOfThisVersion) {
  std::set<std::string> versions;
  for (const auto& entry : std::filesystem::directory_iterator(SourcePath("docs"))) {
    if (entry.path().extension() != ".md") continue;
    versions.merge(
        Found(ReadFile(entry.path()), R"((?:shoal|shoal_rl|libshoal-dev)[-_](\d+\.\d+\.\d+)-)"));
  }
  EXPECT_THAT(versions, ElementsAre(BuildVersion()));
}

TEST(Version, PackagesAndWheelTakeTheProjects) {
  EXPECT_THAT(Found(ReadFile(SourcePath("CMakeLists.txt")), R"(project\(shoal VERSION (\S+))"),
              ElementsAre(BuildVersion()));
  EXPECT_THAT(ReadFile(SourcePath("launch/package/debian.cmake")),
              HasSubstr("CPACK_PACKAGE_VERSION ${PROJECT_VERSION}"));
  EXPECT_THAT(ReadFile(SourcePath("launch/tools/python/pyproject.toml.in")),
              HasSubstr("version = \"@PROJECT_VERSION@\""));
  EXPECT_THAT(ReadFile(SourcePath("common/policy/shoal-policy.pc.in")),
              HasSubstr("Version: @PROJECT_VERSION@"));
}

}  // namespace
}  // namespace shoal
