// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/slurm_array.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/files.h"
#include "tests/launch/tools/experiment/planted_run.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class SlurmArrayTest : public testing::Test {
 protected:
  SlurmArrayTest() {
    Definition definition{.name = "mine", .base = "fetch-reach-state"};
    definition.arms = {{"a", nlohmann::ordered_json::object()}, {"b", {{"learner.batch", 64}}}};
    definition.seeds = {0, 1};
    experiment_ =
        ExperimentFolder(PlanExperiment(folder_.path() / "out", definition, "x.json")).experiment();
  }
  std::vector<ExperimentRun> Runs() const { return experiment_.Runs({0, 1}); }
  std::vector<std::string> Missing(bool retry_failed) const {
    std::vector<std::string> names;
    for (const auto& run : StillToBeDone(experiment_, Runs(), retry_failed)) {
      names.push_back(run.name);
    }
    return names;
  }

  const TemporaryFolder folder_;
  StoredExperiment experiment_;
};

TEST_F(SlurmArrayTest, WhatIsFinishedOrHasFailedIsNotSubmitted) {
  EXPECT_THAT(Missing(false), ElementsAre("a-s0", "b-s0", "a-s1", "b-s1"));
  const RunPlanter finished(Runs()[0].folder), failed(Runs()[1].folder);
  finished.Begin();
  finished.WriteMeta("budget");
  finished.WriteFinal(1, 4);
  failed.Begin();
  failed.WriteMeta("error", "no memory");
  EXPECT_THAT(Missing(false), ElementsAre("a-s1", "b-s1"));
  EXPECT_THAT(Missing(true), ElementsAre("b-s0", "a-s1", "b-s1"));
}

TEST_F(SlurmArrayTest, EachTaskDoesOneRun) {
  const std::string script =
      ArrayScript(experiment_, Runs(), {.at_once = 3, .sbatch_options = {}}, "/opt/it's/shoal");
  EXPECT_THAT(script, HasSubstr("#SBATCH --array=0-3%3\n"));
  EXPECT_THAT(script, HasSubstr("runs=('a-s0' 'b-s0' 'a-s1' 'b-s1')\n"));
  EXPECT_THAT(script, HasSubstr("exec '/opt/it'\\''s/shoal' 'experiment' 'task' '" +
                                experiment_.folder.string() +
                                "' \"${runs[$SLURM_ARRAY_TASK_ID]}\" --side-by-side 3"));
}

TEST_F(SlurmArrayTest, NoMoreTasksAreMarkedAsSideBySideThanThereAre) {
  EXPECT_THAT(ArrayScript(experiment_, Runs(), {}, "shoal"), HasSubstr("--side-by-side 4"));
  EXPECT_THAT(ArrayScript(experiment_, Runs(), {.at_once = 9, .sbatch_options = {}}, "shoal"),
              HasSubstr("--array=0-3%4\n"));
}

TEST_F(SlurmArrayTest, ABrokenNoteOfTheLastArrayIsRefused) {
  WriteFileAtomically(experiment_.folder / "slurm.json", R"({"schema": "something"})");
  EXPECT_THAT(ErrorMessage([&] { SubmitArray(experiment_, Runs(), {}); }),
              HasSubstr("slurm.json: expected an object of schema"));
}

}  // namespace
}  // namespace shoal::launch
