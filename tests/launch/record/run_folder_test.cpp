#include "launch/record/run_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using ::testing::HasSubstr;

template <class Act>
std::string UsageMessage(Act act) {
  try {
    act();
  } catch (const Error& e) {
    EXPECT_EQ(e.exit_code(), 2) << e.what();
    return e.what();
  }
  return "";
}

TEST(RunFolderTest, CreatesTheFolderWithItsSubfolders) {
  const TemporaryFolder dir;
  const RunFolder run = RunFolder::Create(dir.path() / "runs", "a", false);
  EXPECT_EQ(run.path(), dir.path() / "runs" / "a");
  EXPECT_EQ(run.name(), "a");
  for (const char* folder : {"logs", "eval", "checkpoints", "made"}) {
    EXPECT_TRUE(std::filesystem::is_directory(run.path() / folder)) << folder;
  }
}

TEST(RunFolderTest, RefusesAGivenNameThatExists) {
  const TemporaryFolder dir;
  {
    const RunFolder run = RunFolder::Create(dir.path(), "a", false);
    WriteFileAtomically(run.path() / "config.json", "{}");
  }
  EXPECT_THAT(UsageMessage([&] { RunFolder::Create(dir.path(), "a", false); }),
              HasSubstr((dir.path() / "a").string() + "' exists"));
  EXPECT_TRUE(std::filesystem::exists(dir.path() / "a" / "config.json"));
}

TEST(RunFolderTest, NumbersAutomaticNames) {
  const TemporaryFolder dir;
  for (const char* name : {"p-s1", "p-s1-2", "p-s1-3"}) {
    EXPECT_EQ(RunFolder::CreateNumbered(dir.path(), "p-s1").name(), name);
  }
}

TEST(RunFolderTest, OverwritesARunOnlyWhenAsked) {
  const TemporaryFolder dir;
  {
    const RunFolder run = RunFolder::Create(dir.path(), "a", false);
    WriteFileAtomically(run.path() / "config.json", "{}");
    WriteFileAtomically(run.path() / "old", "x");
  }
  const RunFolder run = RunFolder::Create(dir.path(), "a", true);
  EXPECT_FALSE(std::filesystem::exists(run.path() / "old"));
}

TEST(RunFolderTest, NeverOverwritesWhatIsNotARun) {
  const TemporaryFolder dir;
  MakeFolders(dir.path() / "a");
  WriteFileAtomically(dir.path() / "a" / "precious", "x");
  EXPECT_THAT(UsageMessage([&] { RunFolder::Create(dir.path(), "a", true); }),
              HasSubstr("is not a run"));
  EXPECT_EQ(ReadFile(dir.path() / "a" / "precious"), "x");
}

TEST(RunFolderTest, IsHeldAgainstASecondCoordinator) {
  const TemporaryFolder dir;
  const RunFolder run = RunFolder::Create(dir.path(), "a", false);
  WriteFileAtomically(run.path() / "config.json", "{}");
  EXPECT_THAT(UsageMessage([&] { RunFolder::Reopen(dir.path(), "a"); }), HasSubstr("is running"));
  EXPECT_THAT(UsageMessage([&] { RunFolder::Create(dir.path(), "a", true); }),
              HasSubstr("is running"));
}

TEST(RunFolderTest, AskingWhetherItIsHeldDoesNotHoldIt) {
  const TemporaryFolder dir;
  EXPECT_FALSE(IsHeld(dir.path() / "a"));
  {
    const RunFolder run = RunFolder::Create(dir.path(), "a", false);
    WriteFileAtomically(run.path() / "config.json", "{}");
    EXPECT_TRUE(IsHeld(run.path()));
    EXPECT_TRUE(IsHeld(run.path()));
  }
  EXPECT_FALSE(IsHeld(dir.path() / "a"));
  EXPECT_EQ(RunFolder::Reopen(dir.path(), "a").name(), "a");
}

TEST(RunFolderTest, ReopensByNameAndByPath) {
  const TemporaryFolder dir;
  {
    const RunFolder run = RunFolder::Create(dir.path(), "a", false);
    WriteFileAtomically(run.path() / "config.json", "{}");
  }
  EXPECT_EQ(RunFolder::Reopen(dir.path(), "a").name(), "a");
  EXPECT_EQ(RunFolder::Reopen("elsewhere", (dir.path() / "a").string()).name(), "a");
  EXPECT_EQ(RunFolder::Reopen("elsewhere", (dir.path() / "a").string() + "/").name(), "a");
  EXPECT_THAT(UsageMessage([&] { RunFolder::Reopen(dir.path(), "b"); }), HasSubstr("no run 'b'"));
}

TEST(NewestCheckpointTest, ComparesNumbersAndIgnoresOtherNames) {
  const TemporaryFolder run;
  EXPECT_EQ(NewestCheckpoint(run.path()), "");
  for (const char* name :
       {"step_000000900", "step_000002000", "best", "step_000009999.tmp-1", "step_", "step_3000"}) {
    MakeFolders(run.path() / "checkpoints" / name);
  }
  EXPECT_EQ(NewestCheckpoint(run.path()).filename(), "step_000002000");
}

}  // namespace
}  // namespace shoal::launch
