// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/run_leftovers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/member_process.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(RunLeftovers, WaitsForFormerProcessesAndSaysSoOnce) {
  const TemporaryFolder run;
  MemberProcess member(run.path());
  const pid_t pid = member.pid();
  std::vector<std::string> said;
  int looks = 0;
  const auto stop = [&] {
    if (++looks == 3) member.Kill();
    return false;
  };
  WaitForFormerProcesses(run.path(), seconds(60), stop,
                         [&](const std::string& line) { said.push_back(line); });
  EXPECT_EQ(looks, 3);
  EXPECT_THAT(said, ElementsAre(HasSubstr(std::to_string(pid))));
}

TEST(RunLeftovers, AProcessThatStaysIsNamed) {
  const TemporaryFolder run;
  MemberProcess member(run.path());
  const pid_t pid = member.pid();
  try {
    WaitForFormerProcesses(
        run.path(), seconds(0), [] { return false; }, [](const auto&) {});
    ADD_FAILURE() << "did not mind it";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr(std::to_string(pid)), HasSubstr(run.path().string())));
  }
}

TEST(RunLeftovers, ARunWithoutProcessesIsNotWaitedFor) {
  const TemporaryFolder run;
  WaitForFormerProcesses(
      run.path(), seconds(0), [] { return true; },
      [](const std::string& line) { ADD_FAILURE() << line; });
}

TEST(RunLeftovers, RemovesWhatWasBeingWrittenAndNothingElse) {
  const TemporaryFolder run;
  for (const char* folder :
       {"checkpoints/step_000000020", "checkpoints/.step_000000040.tmp-77",
        "checkpoints/.step_000000010.old", "checkpoints/.best.tmp", ".scratch.tmp-31", "made"}) {
    MakeFolders(run.path() / folder);
    WriteFileAtomically(run.path() / folder / "content", "x");
  }
  for (const char* file :
       {"meta.json", "meta.json.tmp-12", "made/actor-0-5.page", "made/actor-0-6.page.tmp-9",
        "replay.ring", "replay.ring.new", "accounting.json.new", "notes.tmp-of-mine", "news.new"}) {
    WriteFileAtomically(run.path() / file, "x");
  }
  EXPECT_EQ(RemoveUnfinishedFiles(run.path()), 8);
  std::set<std::string> left;
  for (const auto& entry : fs::recursive_directory_iterator(run.path())) {
    if (entry.is_regular_file()) left.insert(fs::relative(entry.path(), run.path()));
  }
  EXPECT_THAT(
      left, ElementsAre("checkpoints/step_000000020/content", "made/actor-0-5.page", "made/content",
                        "meta.json", "news.new", "notes.tmp-of-mine", "replay.ring"));
}

}  // namespace
}  // namespace shoal::launch
