// SPDX-License-Identifier: Apache-2.0
// Finds headers without a source that only one file includes. Their declarations belong into that
// file, unless they are long.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "common/base/files.h"
#include "tests/support/paths.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr int kMostShortLines = 20;

// Text of each file of the tree that may include a header, by its path. A source that the build
// writes is a template (.in) or a script of CMake here.
using Tree = std::map<std::string, std::string>;

Tree ReadTree(const fs::path& root) {
  Tree tree;
  for (const char* top : {"actor", "common", "launch", "learner", "replay_server", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const std::string kind = entry.path().extension();
      if (kind != ".h" && kind != ".cpp" && kind != ".c" && kind != ".in" && kind != ".cmake") {
        continue;
      }
      tree[entry.path().lexically_relative(root)] = ReadFile(entry.path());
    }
  }
  return tree;
}

// By header, the files that include it.
std::map<std::string, std::set<std::string>> UsersOf(const Tree& tree) {
  static const std::regex include(R"rx(#\s*include\s+\\?"([^"\\]+))rx");
  std::map<std::string, std::set<std::string>> users;
  for (const auto& [file, text] : tree) {
    for (std::sregex_iterator found(text.begin(), text.end(), include), none; found != none;
         ++found) {
      users[(*found)[1]].insert(file);
    }
  }
  return users;
}

int LinesOfCode(const std::string& text) {
  int lines = 0;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    const size_t first = line.find_first_not_of(' ');
    if (first != std::string::npos && line.compare(first, 2, "//") != 0) ++lines;
  }
  return lines;
}

std::vector<std::string> ShortHeadersOfOneUser(const Tree& tree) {
  std::vector<std::string> faults;
  const auto users = UsersOf(tree);
  for (const auto& [file, text] : tree) {
    if (!file.ends_with(".h")) continue;
    const auto found = users.find(file);
    const int lines = LinesOfCode(text);
    if (found == users.end() || found->second.size() != 1 || lines > kMostShortLines) continue;
    faults.push_back(fmt::format("{}: {} lines of code, included by {} alone: join them", file,
                                 lines, *found->second.begin()));
  }
  return faults;
}

TEST(HeaderUsers, NoShortHeaderHasOneUser) {
  const Tree tree = ReadTree(SourcePath(""));
  EXPECT_GT(tree.size(), 1000u);
  EXPECT_THAT(ShortHeadersOfOneUser(tree), IsEmpty());
}

TEST(HeaderUsers, ShortHeadersOfOneUserAreFound) {
  const std::string include_a = "#include \"b/a.h\"\n", short_text = "// Text.\n\nint A();\n";
  std::string long_text;
  for (int line = 0; line <= kMostShortLines; ++line) long_text += "int A();\n";
  EXPECT_THAT(ShortHeadersOfOneUser({{"b/a.h", short_text}, {"b/c.cpp", include_a}}),
              ElementsAre("b/a.h: 1 lines of code, included by b/c.cpp alone: join them"));
  EXPECT_THAT(ShortHeadersOfOneUser({{"b/a.h", long_text}, {"b/c.cpp", include_a}}), IsEmpty());
  EXPECT_THAT(ShortHeadersOfOneUser(
                  {{"b/a.h", short_text}, {"b/a.cpp", include_a}, {"b/c.cpp", include_a}}),
              IsEmpty());
  EXPECT_THAT(ShortHeadersOfOneUser({{"b/a.h", short_text},
                                     {"b/c.cpp", include_a},
                                     {"b/write.cmake", R"(set(t "#include \"b/a.h\"\n"))"}}),
              IsEmpty());
}

}  // namespace
}  // namespace shoal
