// SPDX-License-Identifier: Apache-2.0
#include "common/base/search_path.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;

TEST(SearchPath, TheFirstExecutableFileIsFound) {
  const TemporaryFolder folder;
  for (const char* name : {"a", "b", "c"}) fs::create_directories(folder.path() / name / "x");
  const fs::path plain = folder.path() / "b" / "tool", program = folder.path() / "c" / "tool";
  for (const fs::path& file : {plain, program}) std::ofstream(file) << "#!/bin/sh\n";
  fs::permissions(program, fs::perms::owner_all);
  const std::string before = std::getenv("PATH");
  const std::string path = (folder.path() / "a").string() + ":" + (folder.path() / "b").string() +
                           ":" + (folder.path() / "c").string();
  setenv("PATH", path.c_str(), 1);
  const auto found = FindOnSearchPath("tool"), directory = FindOnSearchPath("x");
  unsetenv("PATH");
  const auto without = FindOnSearchPath("tool");
  setenv("PATH", before.c_str(), 1);
  EXPECT_EQ(found, program);
  EXPECT_EQ(directory, std::nullopt) << "folders are no programs";
  EXPECT_EQ(without, std::nullopt);
}

}  // namespace
}  // namespace shoal
