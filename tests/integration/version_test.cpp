// `--version` of every program.
#include <gtest/gtest.h>

#include "common/base/build_info.h"
#include "tests/support/program.h"

namespace shoal {
namespace {

TEST(Version, EveryProgramSaysWhichBuildItIs) {
  for (const char* program : {"shoal", "shoal-actor", "shoal-learner", "shoal-replay"}) {
    const ProgramResult result = RunProgram({program, "--version"}, std::chrono::seconds(10));
    EXPECT_EQ(ExitCode(result), 0) << program << ": " << result.err;
    EXPECT_NE(result.out.find(BuildVersion()), std::string::npos) << program << ": " << result.out;
  }
}

}  // namespace
}  // namespace shoal
