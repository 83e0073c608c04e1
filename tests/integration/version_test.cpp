// SPDX-License-Identifier: Apache-2.0
// `--version` of every program.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "common/base/build_info.h"
#include "tests/support/program.h"

namespace shoal {
namespace {

TEST(Version, EveryProgramSaysWhichBuildItIs) {
  for (const char* program :
       {"shoal", "shoal-actor", "shoal-learner", "shoal-replay", "shoal-bench",
        "shoal-bench-actors", "shoal-bench-weights", "shoal-fake-actor", "shoal-soak"}) {
    const ProgramResult result = RunProgram({program, "--version"}, std::chrono::seconds(10));
    EXPECT_EQ(ExitCode(result), 0) << program << ": " << result.err;
    EXPECT_EQ(result.out, fmt::format("{} {} ({}), licence Apache-2.0\n", program, BuildVersion(),
                                      BuildCommit()));
  }
}

TEST(Version, EveryProgramRefusesAnOptionThatItDoesNotHave) {
  for (const char* program :
       {"shoal", "shoal-actor", "shoal-learner", "shoal-replay", "shoal-bench",
        "shoal-bench-actors", "shoal-bench-weights", "shoal-fake-actor", "shoal-soak"}) {
    const ProgramResult result = RunProgram({program, "--nonsense"}, std::chrono::seconds(10));
    EXPECT_EQ(ExitCode(result), 2) << program;
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << program << ": " << result.err;
  }
}

}  // namespace
}  // namespace shoal
