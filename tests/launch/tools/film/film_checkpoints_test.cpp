// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/film/film_checkpoints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/checkpoint/checkpoint_files.h"
#include "launch/record/kept_checkpoints.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class FilmCheckpointsTest : public testing::Test {
 protected:
  void Store(uint64_t updates) const {
    MakeFolders(run_ / "checkpoints");
    WriteFileAtomically(run_ / "config.json", "{}");
    CheckpointFiles files;
    files.state.updates = updates;
    files.state.precision = "f32";
    files.learner = files.policy = "tensors";
    WriteCheckpointFiles(run_ / "checkpoints", files, nlohmann::ordered_json::object());
  }
  std::vector<std::string> Across() const {
    std::vector<std::string> names;
    for (const fs::path& path : CheckpointsAcross(run_)) names.push_back(path.filename());
    return names;
  }
  const TemporaryFolder folder_;
  const fs::path run_ = folder_.path() / "run";
};

TEST_F(FilmCheckpointsTest, ARunWithoutACheckpointIsNamed) {
  MakeFolders(run_);
  WriteFileAtomically(run_ / "config.json", "{}");
  try {
    Across();
    ADD_FAILURE() << "of what?";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr(run_.string()), HasSubstr("no checkpoint yet")));
  }
}

TEST_F(FilmCheckpointsTest, AcrossThemAreTheFirstTwoBetweenAndTheBest) {
  for (uint64_t updates = 1; updates <= 8; ++updates) Store(updates);
  EXPECT_THAT(Across(), ElementsAre(CheckpointName(1), CheckpointName(3), CheckpointName(5),
                                    CheckpointName(8)));
  KeepCheckpoints(run_, {CheckpointName(3)}, CheckpointName(3));
  EXPECT_THAT(Across(), ElementsAre(CheckpointName(1), CheckpointName(2), "best"));
  KeepCheckpoints(run_, {CheckpointName(1)}, CheckpointName(1));
  EXPECT_THAT(Across(), ElementsAre("best"));
}

}  // namespace
}  // namespace shoal::launch
