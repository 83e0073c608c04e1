// SPDX-License-Identifier: Apache-2.0
#include "launch/run/run_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/base/files.h"
#include "common/checkpoint/checkpoint_files.h"
#include "common/run_folder/run_file_names.h"
#include "common/run_folder/update_page.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class RunRecordTest : public testing::Test {
 protected:
  RunRecordTest() { MakeFolders(checkpoints_); }

  // Writes a checkpoint, and returns an evaluation of it.
  EvaluationPoint Make(uint64_t updates, double mean_return) const {
    CheckpointFiles files;
    files.state.updates = updates;
    files.policy = "policy " + std::to_string(updates);
    WriteCheckpointFiles(checkpoints_, files, nlohmann::ordered_json::object());
    return Named(CheckpointName(updates), mean_return);
  }
  static EvaluationPoint Named(const std::string& checkpoint, double mean_return) {
    EvaluationPoint point;
    point.checkpoint = checkpoint;
    point.mean_return = mean_return;
    return point;
  }
  std::string Best() const { return ReadFile(checkpoints_ / kBestCheckpoint / kPolicyFile); }

  TemporaryFolder run_;
  const fs::path checkpoints_ = run_.path() / kCheckpointFolder;
  std::vector<std::string> lines_;
  RunRecord record_{run_.path(), Config{},
                    [this](const std::string& line) { lines_.push_back(line); }};
};

TEST_F(RunRecordTest, KeepsTheCheckpointOfTheBestCandidate) {
  record_.KeepCheckpointsOf({Make(1, 5), Make(2, 3)});
  EXPECT_EQ(Best(), "policy 1");
  EXPECT_TRUE(fs::exists(checkpoints_ / kCandidateFolder / CheckpointName(2)));
  EXPECT_THAT(lines_, IsEmpty());
}

TEST_F(RunRecordTest, ACheckpointThatCannotBeKeptIsTriedAgain) {
  const EvaluationPoint point = Named(CheckpointName(7), 1);
  fs::create_directories(checkpoints_ / point.checkpoint);  // without its files
  record_.KeepCheckpointsOf({point});
  EXPECT_THAT(record_.faults().failing(), ElementsAre("checkpoints/best"));
  record_.Retry();
  EXPECT_THAT(lines_, ElementsAre(HasSubstr("retried")));
  fs::remove_all(checkpoints_ / point.checkpoint);
  Make(7, 1);
  record_.Retry();
  EXPECT_THAT(record_.faults().failing(), IsEmpty());
  EXPECT_EQ(Best(), "policy 7");
  EXPECT_THAT(lines_, ElementsAre(HasSubstr("retried"), "checkpoints/best: written again"));
}

TEST_F(RunRecordTest, WithoutAWrittenCheckpointTheFormerBestStays) {
  record_.KeepCheckpointsOf({Make(1, 5)});
  record_.KeepCheckpointsOf({Named(CheckpointName(2), 9)});
  EXPECT_EQ(Best(), "policy 1");
  EXPECT_THAT(lines_, ElementsAre(HasSubstr("was never written")));
}

TEST_F(RunRecordTest, SaysWhereALearnerThatCannotWriteExplainsIt) {
  record_.OnUnwrittenCheckpoints(1, "learner-0");
  EXPECT_THAT(lines_, ElementsAre(HasSubstr((run_.path() / "logs/learner-0.log").string())));
}

TEST_F(RunRecordTest, MetaCountsTheUpdatesThatWereLostWithALearner) {
  UpdatePage(run_.path(), 0).SetDone(10);
  const UpdatePage successor(run_.path(), /*restored=*/4);
  RunMeta written;
  written.updates = 12;
  record_.WriteMeta(written);
  const auto meta = nlohmann::json::parse(ReadFile(run_.path() / kMetaFile));
  EXPECT_EQ(meta.at("updates"), 12);
  EXPECT_EQ(meta.at("updates_lost"), 6);
}

TEST_F(RunRecordTest, AMetaThatCannotBeWrittenIsAFaultUntilItIsWritten) {
  fs::create_directories(run_.path() / kMetaFile);
  record_.WriteMeta({});
  EXPECT_THAT(record_.faults().failing(), ElementsAre(kMetaFile));
  fs::remove_all(run_.path() / kMetaFile);
  record_.WriteMeta({});
  EXPECT_THAT(record_.faults().failing(), IsEmpty());
}

}  // namespace
}  // namespace shoal::launch
