// SPDX-License-Identifier: Apache-2.0
#include "launch/record/kept_checkpoints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/base/files.h"
#include "common/checkpoint/checkpoint_files.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

class KeptCheckpointsTest : public ::testing::Test {
 protected:
  KeptCheckpointsTest() { MakeFolders(checkpoints_); }

  std::string Make(uint64_t updates, const std::string& policy) const {
    CheckpointFiles files;
    files.state.updates = updates;
    files.policy = policy;
    WriteCheckpointFiles(checkpoints_, files, nlohmann::ordered_json::object());
    return CheckpointName(updates);
  }
  void Prune(const std::string& name) const { fs::remove_all(checkpoints_ / name); }
  void Keep(const std::vector<std::string>& candidates, const std::string& best) const {
    KeepCheckpoints(run_.path(), candidates, best);
  }
  std::string Best() const { return ReadFile(checkpoints_ / "best" / kPolicyFile); }
  static std::vector<std::string> Names(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) {
      names.push_back(entry.path().filename());
    }
    return names;
  }

  TemporaryFolder run_;
  const fs::path checkpoints_ = run_.path() / "checkpoints";
};

TEST_F(KeptCheckpointsTest, TheBestReplacesTheFormerBest) {
  const std::string one = Make(1, "one"), two = Make(2, "two");
  Keep({one}, one);
  EXPECT_EQ(Best(), "one");
  Keep({two}, two);
  EXPECT_EQ(Best(), "two");
  EXPECT_THAT(Names(checkpoints_), UnorderedElementsAre(one, two, "best", "candidates"));
  EXPECT_THAT(Names(checkpoints_ / "candidates"), UnorderedElementsAre(two));
}

TEST_F(KeptCheckpointsTest, ACandidateMayBecomeTheBestWhenItsCheckpointIsPruned) {
  const std::string one = Make(1, "one"), two = Make(2, "two"), three = Make(3, "three");
  Keep({one}, one);
  Keep({one, two}, one);
  Prune(one);
  Prune(two);
  Keep({two, three}, two);
  EXPECT_EQ(Best(), "two");
  EXPECT_THAT(Names(checkpoints_ / "candidates"), UnorderedElementsAre(two, three));
}

TEST_F(KeptCheckpointsTest, ACheckpointThatWasMadeAnewIsKeptAnew) {
  const std::string one = Make(1, "one");
  Keep({one}, one);
  Prune(one);
  Make(1, "another");
  Keep({one}, one);
  EXPECT_EQ(Best(), "another");
}

TEST_F(KeptCheckpointsTest, WhatIsGoneLeavesTheFormerBest) {
  const std::string one = Make(1, "one");
  Keep({one}, one);
  const std::string gone = CheckpointName(9);
  EXPECT_THAT(ErrorMessage([&] { Keep({one, gone}, gone); }), HasSubstr(gone));
  EXPECT_EQ(Best(), "one");
}

TEST_F(KeptCheckpointsTest, AnAlteredOneIsRefusedAndLeavesTheFormerBest) {
  const std::string one = Make(1, "one"), two = Make(2, "two");
  Keep({one}, one);
  WriteFileAtomically(checkpoints_ / two / kPolicyFile, "twp");
  EXPECT_THAT(ErrorMessage([&] { Keep({two}, two); }),
              AllOf(HasSubstr("step_000000002/policy.safetensors"), HasSubstr("CRC-32")));
  EXPECT_EQ(Best(), "one");
  EXPECT_THAT(Names(checkpoints_ / "candidates"), UnorderedElementsAre(one));
}

}  // namespace
}  // namespace shoal::launch
