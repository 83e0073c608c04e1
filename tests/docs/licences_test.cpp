// SPDX-License-Identifier: Apache-2.0
// docs/licences.md names every library that a program is linked with.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <set>
#include <sstream>
#include <string>

#include "common/base/files.h"
#include "tests/support/paths.h"
#include "tests/support/program.h"

namespace shoal {
namespace {

using testing::HasSubstr;

// "libddsc" of each line "  NEEDED  libddsc.so.0debian" of objdump, but for the system's own.
std::set<std::string> LibrariesIn(const std::string& listing) {
  static const std::set<std::string> kSystem = {"ld-linux-x86-64", "libc", "libm"};
  std::set<std::string> libraries;
  std::istringstream words(listing);
  for (std::string word; words >> word;) {
    if (word != "NEEDED" || !(words >> word)) continue;
    const std::string name = word.substr(0, word.find(".so"));
    if (!kSystem.contains(name)) libraries.insert(name);
  }
  return libraries;
}

TEST(Licences, ThePageNamesEveryLibraryOfThePrograms) {
  const std::string page = ReadFile(SourcePath("docs/licences.md"));
  std::set<std::string> all;
  for (const char* program : {"shoal", "shoal-actor", "shoal-learner", "shoal-replay"}) {
    const ProgramResult listing =
        RunCommand({"/usr/bin/objdump", "-p", ProgramPath(program)}, std::chrono::seconds(20));
    ASSERT_EQ(ExitCode(listing), 0) << listing.err;
    for (const std::string& library : LibrariesIn(listing.out)) {
      EXPECT_THAT(page, HasSubstr(fmt::format("`{}`", library))) << program;
      all.insert(library);
    }
  }
  EXPECT_GE(all.size(), 20u);
}

}  // namespace
}  // namespace shoal
