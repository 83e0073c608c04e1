// SPDX-License-Identifier: Apache-2.0
// Each source names its licence at its beginning. Users copy the examples and what `shoal new`
// writes: those files carry no licence line (docs/licences.md).
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr char kLine[] = "SPDX-License-Identifier: Apache-2.0";

bool IsSource(const fs::path& file) {
  static const std::set<std::string> kExtensions = {
      ".c",   ".cmake", ".cpp",   ".css", ".h",    ".idl",     ".js",
      ".map", ".py",    ".proto", ".sh",  ".supp", ".service", ".sbatch"};
  static const std::set<std::string> kNames = {"CMakeLists.txt", "Containerfile", "run"};
  const std::string name = file.filename();
  // "pyproject.toml.in" and others that CMake fills in
  return kNames.contains(name) || kExtensions.contains(file.extension()) ||
         (file.extension() == ".in" && name != "changelog.Debian.in");
}

// Folders of the tree that have no sources of Shoal's own licence, or none at all.
bool IsLeftOut(const std::string& folder) {
  static const std::set<std::string> kFolders = {".cache",
                                                 ".git",
                                                 "build",
                                                 "docs/examples",
                                                 "docs/results",
                                                 "experiments",
                                                 "launch/tools/project/template",
                                                 "runs",
                                                 "tests/fuzz/corpus"};
  return kFolders.contains(folder);
}

// At the beginning: a script's first line says what runs it.
bool SaysItsLicence(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  for (int i = 0; i < 2 && std::getline(in, line); ++i) {
    if (line.find(kLine) != std::string::npos) return true;
  }
  return false;
}

// The number of sources below `root`, and the sources without the line.
struct Found {
  size_t sources = 0;
  std::vector<std::string> without;
};

Found Look(const fs::path& root) {
  Found found;
  for (auto it = fs::recursive_directory_iterator(root); it != fs::end(it); ++it) {
    const std::string path = it->path().lexically_relative(root);
    if (it->is_directory()) {
      if (IsLeftOut(path)) it.disable_recursion_pending();
    } else if (it->is_regular_file() && IsSource(path)) {
      ++found.sources;
      if (!SaysItsLicence(it->path())) found.without.push_back(path);
    }
  }
  std::ranges::sort(found.without);
  return found;
}

TEST(Licence, EverySourceNamesIt) {
  const Found found = Look(SourcePath(""));
  EXPECT_GT(found.sources, 1000u);
  EXPECT_THAT(found.without, IsEmpty())
      << "begin each of these files with a comment '" << kLine << "'";
}

TEST(Licence, SourcesWithoutItAreNamedAndExamplesAreNot) {
  const TemporaryFolder tree;
  const auto write = [&](const std::string& file, const std::string& text) {
    fs::create_directories((tree.path() / file).parent_path());
    std::ofstream(tree.path() / file) << text;
  };
  write("actor/a.cpp", fmt::format("// {}\n", kLine));
  write("actor/b.cpp", "#include <vector>\n");
  write("actor/late.h", fmt::format("#pragma once\n\n// {}\n", kLine));
  write("docs/examples/c.cpp", "int c;\n");
  write("docs/page.md", "# Page\n");
  write("launch/tools/project/template/CMakeLists.txt", "project(x)\n");
  write("run", fmt::format("#!/usr/bin/env bash\n# {}\n", kLine));
  write("x.service", "[Unit]\n");
  const Found found = Look(tree.path());
  EXPECT_EQ(found.sources, 5u);
  EXPECT_THAT(found.without, ElementsAre("actor/b.cpp", "actor/late.h", "x.service"));
}

}  // namespace
}  // namespace shoal
