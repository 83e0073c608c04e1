// SPDX-License-Identifier: Apache-2.0
#include "launch/record/run_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/files.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/without_rights.h"

namespace shoal::launch {
namespace {

using ::testing::HasSubstr;

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

TEST(FindNamed, SaysWhereItLookedOnceEach) {
  EXPECT_EQ(UsageMessage([] { FindNamed("/absent", RunsIn("runs")); }),
            "no run '/absent': there is no config.json in '/absent'");
  EXPECT_EQ(UsageMessage([] { FindNamed("absent", RunsIn("runs")); }),
            "no run 'absent': there is no config.json in 'runs/absent', 'absent'");
}

TEST(FindNamed, AnotherUsersRunMayNotBeReadWhichIsSaid) {
  const TemporaryFolder dir;
  { RunFolder::Create(dir.path(), "theirs", false); }
  const WithoutRights closed(dir.path() / "theirs");
  EXPECT_EQ(ErrorMessage(1, [&] { FindNamed("theirs", RunsIn(dir.path())); }),
            "run '" + (dir.path() / "theirs").string() + "': permission denied");
  EXPECT_TRUE(IsForbidden(dir.path() / "theirs"));
  EXPECT_FALSE(IsForbidden(dir.path() / "absent"));
}

TEST(RunFolderTest, AResumedRunIsCalledAsItWasNamed) {
  const TemporaryFolder dir;
  {
    const RunFolder run = RunFolder::Create(dir.path() / "runs", "a", false);
    WriteFileAtomically(run.path() / "config.json", "{}");
  }
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(dir.path());
  for (const char* words : {"a", "runs/a", "runs/./a/"}) {
    const RunFolder run = RunFolder::Reopen("runs", words);
    EXPECT_EQ(run.path(), "runs/a") << words;
    EXPECT_EQ(run.name(), "a") << words;
  }
  std::filesystem::current_path("runs/a");
  EXPECT_EQ(RunFolder::Reopen("runs", ".").name(), "a");
  std::filesystem::current_path(before);
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

TEST(FindNamedTest, TheNameComesBeforeTheFolder) {
  const TemporaryFolder dir;
  const NamedKind runs = RunsIn(dir.path() / "runs");
  const NamedKind others{.noun = "other", .dir = dir.path() / "others", .file = "other.json"};
  const auto plant = [&](const std::filesystem::path& folder, const char* file) {
    MakeFolders(folder);
    WriteFileAtomically(folder / file, "{}");
    return folder;
  };
  const auto named = plant(dir.path() / "runs/a", "config.json");
  const auto other = plant(dir.path() / "others/b", "other.json");
  const auto path = plant(dir.path() / "c", "config.json");
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(plant(dir.path() / "here/a", "config.json").parent_path());
  EXPECT_EQ(FindNamed("a", runs), named);
  std::filesystem::current_path(before);
  const std::array kinds{runs, others};
  EXPECT_EQ(FindNamed("b", kinds), other);
  EXPECT_EQ(FindNamed(path.string(), kinds), path);
  const std::string refusal = UsageMessage([&] { FindNamed("d", kinds); });
  for (const std::string& part : {std::string("no run or other 'd'"), (runs.dir / "d").string(),
                                  (others.dir / "d").string(), std::string("other.json")}) {
    EXPECT_THAT(refusal, HasSubstr(part));
  }
}

TEST(JudgedCheckpointTest, IsTheBestElseTheNewest) {
  const TemporaryFolder run;
  EXPECT_EQ(JudgedCheckpoint(run.path()), "");
  MakeFolders(run.path() / "checkpoints/step_000000900");
  EXPECT_EQ(JudgedCheckpoint(run.path()).filename(), "step_000000900");
  MakeFolders(run.path() / "checkpoints/best");
  EXPECT_EQ(JudgedCheckpoint(run.path()).filename(), "best");
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
