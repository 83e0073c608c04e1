// SPDX-License-Identifier: Apache-2.0
#include "common/run_folder/update_page.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

TEST(UpdatePage, WhatALearnerDidBeyondItsSuccessorsCheckpointIsLost) {
  const TemporaryFolder run;
  EXPECT_EQ(ReadLostUpdates(run.path()), 0u);
  {
    UpdatePage first(run.path(), 0);
    for (uint64_t update = 1; update <= 130; ++update) first.SetDone(update);
  }
  {
    UpdatePage second(run.path(), 100);
    EXPECT_EQ(second.lost(), 30u);
    second.SetDone(101);
  }
  EXPECT_EQ(UpdatePage(run.path(), 0).lost(), 131u) << "no checkpoint at all";
  EXPECT_EQ(ReadLostUpdates(run.path()), 131u);
}

TEST(UpdatePage, WhatIsInTheCheckpointIsNotLost) {
  const TemporaryFolder run;
  UpdatePage(run.path(), 0).SetDone(50);
  EXPECT_EQ(UpdatePage(run.path(), 50).lost(), 0u);
  EXPECT_EQ(UpdatePage(run.path(), 70).lost(), 0u) << "of a learner without a page";
  EXPECT_EQ(UpdatePage(run.path(), 70).lost(), 0u);
}

TEST(UpdatePage, TheLastUpdateBeforeASigkillCounts) {
  const TemporaryFolder run;
  const pid_t learner = fork();
  if (learner == 0) {
    UpdatePage page(run.path(), 0);
    page.SetDone(7);
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(learner, &status, 0), learner);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(UpdatePage(run.path(), 5).lost(), 2u);
}

TEST(UpdatePage, AnotherFileIsRefusedByName) {
  const TemporaryFolder run;
  for (const char* bytes :
       {"", "SHOALUP1", "SHOALUP2aaaaaaaabbbbbbbb", "SHOALUP1aaaaaaaabbbbbbbbc"}) {
    WriteFileAtomically(run.path() / "learner.page", bytes);
    EXPECT_THROW(UpdatePage(run.path(), 0), Error) << bytes;
    try {
      ReadLostUpdates(run.path());
      ADD_FAILURE() << bytes;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("learner.page"), std::string::npos);
    }
  }
}

TEST(UpdatePage, ADamagedPageIsRebuilt) {
  const TemporaryFolder run;
  WriteFileAtomically(run.path() / "learner.page", "torn");
  RebuildUpdatePage(run.path(), 120, 30);
  EXPECT_EQ(ReadLostUpdates(run.path()), 30u);
  EXPECT_EQ(UpdatePage(run.path(), 100).lost(), 50u);
}

// A limit on files' sizes stands in for a full disk.
TEST(UpdatePage, GoesOnInItsPlaceOnAFullDisk) {
  const TemporaryFolder run;
  UpdatePage(run.path(), 0).SetDone(50);
  const pid_t learner = fork();
  if (learner == 0) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{0, 0};
    setrlimit(RLIMIT_FSIZE, &limit);
    UpdatePage page(run.path(), 40);
    page.SetDone(41);
    _exit(static_cast<int>(page.lost()));
  }
  int status = 0;
  waitpid(learner, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 10);
  EXPECT_EQ(UpdatePage(run.path(), 40).lost(), 11u);
}

}  // namespace
}  // namespace shoal
