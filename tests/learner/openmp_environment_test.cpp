// SPDX-License-Identifier: Apache-2.0
#include "learner/openmp_environment.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

namespace shoal::learner {
namespace {

constexpr char kSecondStart[] = "SHOAL_TEST_SECOND_START";

// Forks, and lets the child start this very test anew.
TEST(EnsurePassiveOpenMp, StartsTheProgramAnewOnceWithPassiveThreads) {
  if (std::getenv(kSecondStart) != nullptr) {
    ASSERT_STREQ(std::getenv("OMP_WAIT_POLICY"), "passive");
    ASSERT_STREQ(std::getenv("OMP_NUM_THREADS"), "3");
    unsetenv("OMP_WAIT_POLICY");
    EnsurePassiveOpenMp(5, nullptr);  // a third start would fail
    return;
  }
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    unsetenv("OMP_WAIT_POLICY");
    unsetenv("OMP_NUM_THREADS");
    setenv(kSecondStart, "1", 1);
    char name[] = "test", filter[] = "--gtest_filter=EnsurePassiveOpenMp.StartsTheProgram*";
    char* argv[] = {name, filter, nullptr};
    EnsurePassiveOpenMp(3, argv);
    _exit(99);  // did not start anew
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(EnsurePassiveOpenMp, LeavesTheUsersChoiceAlone) {
  setenv("OMP_WAIT_POLICY", "active", 1);
  EnsurePassiveOpenMp(3, nullptr);
  EXPECT_STREQ(std::getenv("OMP_WAIT_POLICY"), "active");
  unsetenv("OMP_WAIT_POLICY");
}

}  // namespace
}  // namespace shoal::learner
