// SPDX-License-Identifier: Apache-2.0
#include "common/base/file_lock.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

using std::chrono::milliseconds;

class FileLockTest : public testing::Test {
 protected:
  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "lock";
};

TEST_F(FileLockTest, ExcludesOthersUntilItsEnd) {
  EXPECT_FALSE(IsLocked(file_)) << "no file";
  auto alone = FileLock::Take(file_);
  ASSERT_TRUE(alone);
  EXPECT_TRUE(IsLocked(file_));
  EXPECT_FALSE(FileLock::Take(file_));
  EXPECT_FALSE(FileLock::Take(file_, Holding::kWithOthers));
  alone.reset();
  EXPECT_FALSE(IsLocked(file_));
  EXPECT_TRUE(FileLock::Take(file_));
}

TEST_F(FileLockTest, IsSharedByThoseWhoHoldItWithOthers) {
  const auto one = FileLock::Take(file_, Holding::kWithOthers);
  const auto other = FileLock::Take(file_, Holding::kWithOthers);
  EXPECT_TRUE(one && other);
  EXPECT_TRUE(IsLocked(file_));
  EXPECT_FALSE(FileLock::Take(file_));
}

TEST_F(FileLockTest, WaitsForItsTurnUntilTheDeadline) {
  auto first = FileLock::Take(file_);
  EXPECT_FALSE(FileLock::Take(file_, Holding::kAlone, milliseconds(50)));
  first.reset();
  EXPECT_TRUE(FileLock::Take(file_, Holding::kAlone, milliseconds(0)));
}

TEST_F(FileLockTest, EndsWithItsProcess) {
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t holder = fork();
  if (holder == 0) {
    const auto lock = FileLock::Take(file_);
    const char held = lock ? 'y' : 'n';
    if (write(ready[1], &held, 1) == 1) pause();
    _exit(1);
  }
  char held = 0;
  ASSERT_EQ(read(ready[0], &held, 1), 1);
  EXPECT_EQ(held, 'y');
  EXPECT_TRUE(IsLocked(file_));
  kill(holder, SIGKILL);
  waitpid(holder, nullptr, 0);
  EXPECT_FALSE(IsLocked(file_));
  close(ready[0]);
  close(ready[1]);
}

TEST_F(FileLockTest, AFileThatCannotBeMadeIsNamed) {
  const std::string message = ErrorMessage([&] { FileLock::Take(folder_.path() / "no" / "lock"); });
  EXPECT_NE(message.find("no/lock"), std::string::npos) << message;
}

}  // namespace
}  // namespace shoal
