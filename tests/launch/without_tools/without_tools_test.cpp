// SPDX-License-Identifier: Apache-2.0
// A build with SHOAL_TOOLS=OFF.
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "launch/commands/tool_commands.h"
#include "tests/support/program.h"

namespace shoal::launch {
namespace {

using ::testing::HasSubstr;
using Words = std::vector<std::string>;

ProgramResult Shoal(Words words) {
  words.insert(words.begin(), "shoal-without-tools");
  return RunProgram(std::move(words), std::chrono::seconds(60));
}

// The libraries that the loader maps for a program, transitively.
std::string LibrariesOf(const std::string& program) {
  const ProgramResult result =
      RunCommand({"/usr/bin/ldd", ProgramPath(program)}, std::chrono::seconds(60));
  EXPECT_EQ(ExitCode(result), 0) << result.err;
  return result.out;
}

TEST(WithoutTools, TheProgramNeedsNoLibraryOfTheTools) {
  const std::string with = LibrariesOf("shoal"), without = LibrariesOf("shoal-without-tools");
  for (const std::string library : {"libavcodec", "libavformat", "libswscale", "libcairo",
                                    "libcpp-httplib", "libhdf5", "libprometheus-cpp"}) {
    EXPECT_THAT(with, HasSubstr(library)) << "is the library still called that?";
    EXPECT_THAT(without, Not(HasSubstr(library)));
  }
}

TEST(WithoutTools, EachToolIsRefusedInOneLineThatNamesTheOption) {
  for (Words command : kToolCommands) {
    command.emplace_back("--help");
    const ProgramResult result = Shoal(command);
    EXPECT_EQ(ExitCode(result), 2);
    command.pop_back();
    EXPECT_EQ(result.err,
              fmt::format("shoal: error: shoal {}: not part of this build; configure Shoal with "
                          "-DSHOAL_TOOLS=ON to have it\n",
                          fmt::join(command, " ")));
    EXPECT_EQ(result.out, "");
  }
}

TEST(WithoutTools, OptionsOfARunThatNeedAToolAreRefusedBeforeItStarts) {
  const TemporaryFolder folder;
  const std::string runs = folder.path();
  for (const Words& option : {Words{"--film"}, Words{"--prometheus", "9464"}}) {
    Words words{"train", "--preset", "fetch-reach-fast", "--run-dir", runs};
    words.insert(words.end(), option.begin(), option.end());
    const ProgramResult result = Shoal(words);
    EXPECT_EQ(ExitCode(result), 2);
    EXPECT_THAT(result.err, HasSubstr("SHOAL_TOOLS=ON"));
    EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << option[0];
  }
}

TEST(WithoutTools, ATrainingIsCheckedAsEver) {
  const ProgramResult result = Shoal({"train", "--preset", "fetch-reach-fast", "--dry-run"});
  EXPECT_EQ(ExitCode(result), 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("configuration is valid"));
}

}  // namespace
}  // namespace shoal::launch
