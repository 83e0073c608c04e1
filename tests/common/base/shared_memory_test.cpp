// SPDX-License-Identifier: Apache-2.0
#include "common/base/shared_memory.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "tests/support/error_message.h"

namespace shoal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr uint64_t kBytes = 10'000;

SharedMemory OpenOf(const SharedMemory& made) {
  return SharedMemory::Open(getpid(), made.descriptor(), made.bytes());
}

TEST(SharedMemory, WhatItsMakerWritesAReaderSees) {
  const SharedMemory made = SharedMemory::Make("test", kBytes);
  EXPECT_EQ(made.data()[kBytes - 1], 0);
  const SharedMemory opened = OpenOf(made);
  made.data()[kBytes - 1] = 7;
  EXPECT_EQ(opened.data()[kBytes - 1], 7);
}

TEST(SharedMemory, AReaderCannotWriteIt) {
  const SharedMemory made = SharedMemory::Make("test", kBytes);
  const SharedMemory opened = OpenOf(made);
  EXPECT_EQ(mprotect(opened.data(), kBytes, PROT_READ | PROT_WRITE), -1);
  EXPECT_EQ(errno, EACCES);
}

TEST(SharedMemory, ItCanBeOpenedForWriting) {
  const SharedMemory made = SharedMemory::Make("test", kBytes);
  const SharedMemory opened =
      SharedMemory::Open(getpid(), made.descriptor(), kBytes, SharedMemory::Access::kReadAndWrite);
  opened.data()[kBytes - 1] = 7;
  EXPECT_EQ(made.data()[kBytes - 1], 7);
}

TEST(SharedMemory, MemoryThatIsSealedAgainstWritingCannotBeOpenedForWriting) {
  const Descriptor made = SharedMemory::MakeOf("test", {"abc"});
  EXPECT_THAT(ErrorMessage([&] {
                SharedMemory::Open(getpid(), made.get(), 3, SharedMemory::Access::kReadAndWrite);
              }),
              HasSubstr("shared memory"));
  EXPECT_EQ(SharedMemory::Open(getpid(), made.get(), 3).data()[2], 'c');
}

TEST(SharedMemory, NobodyMakesItSmallerUnderAnother) {
  const SharedMemory made = SharedMemory::Make("test", kBytes);
  EXPECT_EQ(ftruncate(made.descriptor(), 1), -1);
  EXPECT_EQ(errno, EPERM);
}

TEST(SharedMemory, WhatIsMadeOfPiecesIsReadWholeAndNobodyChangesIt) {
  const std::string large(3'000'000, 'x');
  const Descriptor made = SharedMemory::MakeOf("test", {"ab", "", large});
  const SharedMemory opened = SharedMemory::Open(getpid(), made.get(), 2 + large.size());
  const std::string_view read(reinterpret_cast<const char*>(opened.data()), opened.bytes());
  EXPECT_EQ(read.substr(0, 2), "ab");
  EXPECT_EQ(read.substr(2), large);
  EXPECT_EQ(pwrite(made.get(), "c", 1, 0), -1);
  EXPECT_EQ(errno, EPERM);
  EXPECT_EQ(ftruncate(made.get(), 1), -1);
  struct stat status {};
  ASSERT_EQ(fstat(made.get(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600u);
}

TEST(SharedMemory, ItIsItsUsersOwn) {
  const SharedMemory made = SharedMemory::Make("test", kBytes);
  struct stat status {};
  ASSERT_EQ(fstat(made.descriptor(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600u);
}

TEST(SharedMemory, AnotherUserDoesNotGetIn) {
  if (geteuid() != 0) GTEST_SKIP() << "needs root: to be another user";
  const SharedMemory made = SharedMemory::Make("test", kBytes);
  const pid_t maker = getpid();
  const pid_t child = fork();
  if (child == 0) {
    if (setgid(65534) != 0 || setuid(65534) != 0) _exit(1);
    const std::string message =
        ErrorMessage([&] { SharedMemory::Open(maker, made.descriptor(), made.bytes()); });
    _exit(message.find("Permission denied") != std::string::npos ? 0 : 2);
  }
  int code = -1;
  ASSERT_EQ(waitpid(child, &code, 0), child);
  EXPECT_EQ(code, 0);
}

TEST(SharedMemory, OnlyWhatWasMadeHereIsOpened) {
  const SharedMemory made = SharedMemory::Make("test", kBytes);
  EXPECT_THAT(ErrorMessage([&] { SharedMemory::Open(getpid(), made.descriptor(), kBytes + 1); }),
              AllOf(HasSubstr("10000 bytes"), HasSubstr("expected 10001")));
  EXPECT_THAT(ErrorMessage([&] { SharedMemory::Open(getpid(), 100'000, kBytes); }),
              AllOf(HasSubstr("/fd/100000"), HasSubstr("No such file")));
  std::FILE* file = std::tmpfile();
  EXPECT_THAT(ErrorMessage([&] { SharedMemory::Open(getpid(), fileno(file), kBytes); }),
              HasSubstr("no sealed shared memory"));
  std::fclose(file);
  // Without the seal its maker could take pages away that are being read.
  const Descriptor loose(memfd_create("test", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  ASSERT_EQ(ftruncate(loose.get(), kBytes), 0);
  EXPECT_THAT(ErrorMessage([&] { SharedMemory::Open(getpid(), loose.get(), kBytes); }),
              HasSubstr("no sealed shared memory"));
  int pipe_ends[2];
  ASSERT_EQ(pipe2(pipe_ends, O_CLOEXEC), 0);
  EXPECT_THAT(ErrorMessage([&] { SharedMemory::Open(getpid(), pipe_ends[0], kBytes); }),
              HasSubstr("no sealed shared memory"));
  for (const int end : pipe_ends) close(end);
}

// The limit would end the process with a signal where it is not asked for first.
TEST(SharedMemory, ALimitOnFilesIsNamed) {
  struct rlimit before {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  struct rlimit small = before;
  small.rlim_cur = kBytes - 1;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string large(kBytes, 'x');
  const std::string of_zeros = ErrorMessage([] { SharedMemory::Make("test", kBytes); });
  const std::string of_pieces = ErrorMessage([&] { SharedMemory::MakeOf("test", {large}); });
  setrlimit(RLIMIT_FSIZE, &before);
  for (const std::string& message : {of_zeros, of_pieces}) {
    EXPECT_THAT(message,
                AllOf(HasSubstr("10000 bytes"), HasSubstr("9999"), HasSubstr("ulimit -f")));
  }
}

TEST(SharedMemory, ItOutlivesAKilledMakerInItsReaderAndNowhereElse) {
  int words[2];
  ASSERT_EQ(pipe2(words, O_CLOEXEC), 0);
  const pid_t maker = fork();
  if (maker == 0) {
    const SharedMemory made = SharedMemory::Make("test", kBytes);
    made.data()[5] = 9;
    const int descriptor = made.descriptor();
    if (write(words[1], &descriptor, sizeof descriptor) != sizeof descriptor) _exit(1);
    while (true) pause();
  }
  int descriptor = -1;
  ASSERT_EQ(read(words[0], &descriptor, sizeof descriptor), ssize_t{sizeof descriptor});
  const SharedMemory opened = SharedMemory::Open(maker, descriptor, kBytes);
  kill(maker, SIGKILL);
  ASSERT_EQ(waitpid(maker, nullptr, 0), maker);
  EXPECT_EQ(opened.data()[5], 9);
  EXPECT_THAT(ErrorMessage([&] { SharedMemory::Open(maker, descriptor, kBytes); }),
              HasSubstr("No such file"));
  for (const int end : words) close(end);
}

}  // namespace
}  // namespace shoal
