// SPDX-License-Identifier: Apache-2.0
// A system without OSMesa: an empty file replaces the library, which then cannot be opened.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/roomy_folder.h"
#include "tests/support/training_run.h"

namespace shoal {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class MissingOsmesa : public testing::Test {
 protected:
  MissingOsmesa() { WriteFileAtomically(folder_.path() / "libOSMesa.so.8", ""); }

  ProgramResult Run(std::vector<std::string> command) const {
    command[0] = ProgramPath(command[0]);
    return RunCommand(std::move(command), std::chrono::seconds(180),
                      {{"LD_LIBRARY_PATH", folder_.path().string()}});
  }

  TemporaryFolder folder_;
  TrainingRun run_;
};

TEST_F(MissingOsmesa, CheckWarnsAndTheMachineCanTrain) {
  const TemporaryFolder roomy("shoal-", RoomyFolder());
  const ProgramResult result = Run({"shoal", "check", "--run-dir", roomy.path().string()});
  EXPECT_EQ(ExitCode(result), 0) << result.out << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("OK    rendering"), HasSubstr("WARN  opengl"),
                                HasSubstr("libosmesa6"), HasSubstr("OK    training")));
}

TEST_F(MissingOsmesa, ARunInQualityNativeTrainsAndEvaluates) {
  const ProgramResult result =
      Run(run_.Command(TrainingRun::FromPixels({{"observation.quality", "native"}})));
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("Shoal's renderer (native) draws a frame"));
  EXPECT_EQ(run_.Json("eval/final.json").at("aggregate").at("episodes"), 2);
  const ProgramResult film = Run({"shoal", "film", run_.path().string(), "--episodes", "1"});
  EXPECT_EQ(ExitCode(film), 0) << film.out << film.err;
  const ProgramResult other =
      Run({"shoal", "film", run_.path().string(), "--quality", "reference"});
  EXPECT_EQ(ExitCode(other), 1) << other.out << other.err;
  EXPECT_THAT(other.err, HasSubstr("libosmesa6"));
}

TEST_F(MissingOsmesa, ARunInQualityFastIsRefusedInOneLine) {
  const ProgramResult result =
      Run(run_.Command(TrainingRun::FromPixels({{"observation.quality", "fast"}})));
  EXPECT_EQ(ExitCode(result), 1) << result.out << result.err;
  EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
  EXPECT_THAT(result.err, AllOf(HasSubstr("libosmesa6"), HasSubstr("quality=native")));
  EXPECT_FALSE(std::filesystem::exists(run_.path()));
}

}  // namespace
}  // namespace shoal
