// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/scratch_folder.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

TEST(ScratchFolder, IsRemovedWithItsOwner) {
  const TemporaryFolder parent;
  fs::path path;
  {
    const ScratchFolder folder(parent.path());
    path = folder.path();
    EXPECT_EQ(path.parent_path(), parent.path());
    std::ofstream(path / "file") << "text";
  }
  EXPECT_FALSE(fs::exists(path));
}

// The folder of a process that ended without its destructors, as one does that is killed.
fs::path AbandonedIn(const fs::path& parent) {
  const pid_t child = fork();
  if (child == 0) {
    const ScratchFolder folder(parent);
    std::ofstream(folder.path() / "file") << "text" << std::flush;
    std::ofstream(parent / "name") << folder.path().string() << std::flush;
    _exit(0);
  }
  int status = -1;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  return ReadFile(parent / "name");
}

TEST(ScratchFolder, ThoseOfDeadProcessesAreRemovedByTheNext) {
  const TemporaryFolder parent;
  const fs::path abandoned = AbandonedIn(parent.path());
  ASSERT_TRUE(fs::exists(abandoned / "file"));
  const ScratchFolder next(parent.path());
  EXPECT_FALSE(fs::exists(abandoned));
}

TEST(ScratchFolder, FoldersInUseAndFoldersOfOthersStay) {
  const TemporaryFolder parent;
  const ScratchFolder in_use(parent.path());
  const fs::path elsewhere = AbandonedIn(parent.path());
  fs::rename(elsewhere, parent.path() / "kept");
  fs::create_directory_symlink(parent.path() / "kept", parent.path() / "shoal-linked");
  fs::create_directory(parent.path() / "shoal-tmpabc");
  std::ofstream(parent.path() / "shoal-tmpabc/file") << "of another program";
  const ScratchFolder next(parent.path());
  EXPECT_TRUE(fs::exists(in_use.path()));
  EXPECT_TRUE(fs::exists(next.path()));
  EXPECT_TRUE(fs::exists(parent.path() / "shoal-tmpabc/file"));
  EXPECT_TRUE(fs::exists(parent.path() / "kept/file")) << "its link is no scratch folder";
}

}  // namespace
}  // namespace shoal::launch
