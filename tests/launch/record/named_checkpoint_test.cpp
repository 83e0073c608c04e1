// SPDX-License-Identifier: Apache-2.0
#include "launch/record/named_checkpoint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/checkpoint/checkpoint_files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

class NamedCheckpointTest : public ::testing::Test {
 protected:
  NamedCheckpointTest() {
    MakeFolders(run_ / "checkpoints");
    WriteFileAtomically(run_ / "config.json", "{}");
  }
  void Store(const std::string& name) const { MakeFolders(run_ / "checkpoints" / name); }
  NamedCheckpoint Find(const std::string& run, const std::string& checkpoint = "") const {
    return FindCheckpoint({.run = run, .checkpoint = checkpoint, .run_dir = runs_.string()});
  }
  Error Refusal(const std::string& run, const std::string& checkpoint = "") const {
    try {
      Find(run, checkpoint);
    } catch (const Error& e) {
      return e;
    }
    return Error(ErrorKind::kRuntime, "found");
  }
  void ExpectNewest(const NamedCheckpoint& found) const {
    EXPECT_EQ(found.run, run_);
    EXPECT_EQ(found.checkpoint, run_ / "checkpoints" / "step_000000020");
  }

  const TemporaryFolder folder_;
  const fs::path runs_ = folder_.path() / "runs", run_ = runs_ / "first";
};

TEST_F(NamedCheckpointTest, ARunMeansTheBestElseTheNewest) {
  Store("step_000000010");
  Store("step_000000020");
  for (const std::string& words : {std::string("first"), run_.string(), run_.string() + "/"}) {
    ExpectNewest(Find(words));
    ExpectNewest(Find("", words));
  }
  Store("best");
  EXPECT_EQ(Find("first").checkpoint.filename(), "best");
}

TEST_F(NamedCheckpointTest, OneOfARunIsNamedByItsNameOrItsPath) {
  Store("step_000000010");
  Store("step_000000020");
  const fs::path path = run_ / "checkpoints" / "step_000000020";
  ExpectNewest(Find("first", "step_000000020"));
  ExpectNewest(Find("first", path.string()));
  for (const std::string& words :
       {path.string(), path.string() + "/", std::string("first/checkpoints/step_000000020")}) {
    ExpectNewest(Find(words));
    ExpectNewest(Find("", words));
  }
}

TEST_F(NamedCheckpointTest, AFolderOutsideOfARunHasNone) {
  const fs::path copy = folder_.path() / "copy";
  MakeFolders(copy);
  EXPECT_EQ(Find(copy.string()).run, "");
  EXPECT_EQ(Find(copy.string()).checkpoint, copy);
}

// The config.json of a copied checkpoint or of a card says what its run was.
TEST_F(NamedCheckpointTest, ACopyWithBothFilesIsItsOwnRun) {
  const fs::path card = folder_.path() / "card";
  MakeFolders(card);
  WriteFileAtomically(card / "config.json", "{}");
  WriteFileAtomically(card / kStateFile, "{}");
  EXPECT_EQ(Find(card.string()).run, card);
  EXPECT_EQ(Find(card.string()).checkpoint, card);
}

TEST_F(NamedCheckpointTest, WhatIsNotThereIsNamed) {
  EXPECT_THAT(Refusal("first").what(), HasSubstr("no checkpoint yet"));
  EXPECT_EQ(Refusal("first").exit_code(), 1);
  EXPECT_THAT(Refusal("").what(), HasSubstr("nothing is named"));
  Store("step_000000010");
  for (const char* name : {"step_000000011", "../checkpoints/step_000000010", "..", "."}) {
    EXPECT_THAT(Refusal("first", name).what(),
                AllOf(HasSubstr(name), HasSubstr("expected one of: step_000000010")));
    EXPECT_EQ(Refusal("first", name).exit_code(), 2) << name;
  }
  EXPECT_THAT(Refusal("second").what(),
              AllOf(HasSubstr("no run 'second'"), HasSubstr("config.json"),
                    HasSubstr((runs_ / "second").string())));
}

}  // namespace
}  // namespace shoal::launch
