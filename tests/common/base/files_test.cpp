// SPDX-License-Identifier: Apache-2.0
#include "common/base/files.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>

#include "common/base/error.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

int FilesIn(const std::filesystem::path& folder) {
  return static_cast<int>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(Files, WritesAndReplacesWhole) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "x.json";
  WriteFileAtomically(path, "one");
  WriteFileAtomically(path, "two!");
  EXPECT_EQ(ReadFile(path), "two!");
  EXPECT_EQ(FilesIn(folder.path()), 1);
}

TEST(Files, AFreshFolderIsNewAndItsUsersOwn) {
  const TemporaryFolder folder;
  const auto one = MakeFreshFolder("run-", folder.path());
  const auto other = MakeFreshFolder("run-", folder.path());
  EXPECT_NE(one, other);
  EXPECT_EQ(one.parent_path(), folder.path());
  EXPECT_EQ(one.filename().string().substr(0, 4), "run-");
  EXPECT_EQ(std::filesystem::status(one).permissions(), std::filesystem::perms::owner_all);
  const auto nowhere = folder.path() / "absent";
  EXPECT_NE(ErrorMessage([&] { MakeFreshFolder("run-", nowhere); }).find(nowhere.string()),
            std::string::npos);
}

TEST(Files, FollowTheUmaskUntilTheyAreKeptPrivate) {
  const TemporaryFolder folder;
  // KeepFilesPrivate is for a process's whole life.
  const pid_t child = fork();
  if (child == 0) {
    umask(022);
    NoteUmask();
    WriteFileAtomically(folder.path() / "shared", "run");
    WriteFilePrivately(folder.path() / "secret", "key");
    KeepFilesPrivate();
    KeepFilesPrivate();  // the second time it finds its own
    WriteFileAtomically(folder.path() / "own", "key");
    WriteFileForOthers(folder.path() / "report", "page");
    MakeFolders(folder.path() / "card");
    OpenToOthers(folder.path() / "card");
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_EQ(status, 0);
  const auto mode_of = [&](const char* name) {
    struct stat found {};
    EXPECT_EQ(stat((folder.path() / name).c_str(), &found), 0);
    return found.st_mode & 0777;
  };
  EXPECT_EQ(mode_of("shared"), 0644u);
  EXPECT_EQ(mode_of("secret"), 0600u);
  EXPECT_EQ(mode_of("own"), 0600u);
  EXPECT_EQ(mode_of("report"), 0644u);
  EXPECT_EQ(mode_of("card"), 0755u);
}

TEST(Files, AFailedWriteLeavesTheOldFileAndNoOther) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "x.json";
  WriteFileAtomically(path, "old");
  const pid_t child = fork();
  if (child == 0) {  // a file-size limit stands in for a full disk
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{4096, 4096};
    setrlimit(RLIMIT_FSIZE, &limit);
    try {
      WriteFileAtomically(path, std::string(10'000, 'x'));
    } catch (const Error& e) {
      _exit(std::string(e.what()).find("x.json") != std::string::npos ? 42 : 43);
    }
    _exit(44);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 42);
  EXPECT_EQ(ReadFile(path), "old");
  EXPECT_EQ(FilesIn(folder.path()), 1);
}

TEST(Files, ErrorsNameThePath) {
  const TemporaryFolder folder;
  for (const auto& act :
       {+[](const std::filesystem::path& p) { ReadFile(p / "absent"); },
        +[](const std::filesystem::path& p) { ReadFile(p); },
        +[](const std::filesystem::path& p) { WriteFileAtomically(p / "absent" / "x", "y"); }}) {
    try {
      act(folder.path());
      FAIL() << "no error";
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(folder.path().string()), std::string::npos) << e.what();
      EXPECT_EQ(e.exit_code(), 1);
    }
  }
}

TEST(Files, WhatCannotBeWrittenIsRefusedBeforehandAndNothingIsTouched) {
  const TemporaryFolder folder;
  WriteFileAtomically(folder.path() / "there", "old");
  CheckWritable(folder.path() / "new");
  CheckWritable(folder.path() / "there");
  EXPECT_EQ(ReadFile(folder.path() / "there"), "old");
  EXPECT_EQ(FilesIn(folder.path()), 1);
  for (const std::filesystem::path& bad :
       {folder.path(), folder.path() / "absent" / "x", folder.path() / "there" / "x"}) {
    try {
      CheckWritable(bad);
      ADD_FAILURE() << bad << " passed";
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(bad.string()), std::string::npos) << e.what();
    }
  }
}

// Opening a FIFO would wait for its other end: with the check undone, this test hangs.
TEST(Files, AFifoIsRefusedAtOnceUnlessTheUserNamesIt) {
  const TemporaryFolder folder;
  const auto fifo = folder.path() / "meta.json";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  for (const int flags : {O_RDONLY, O_WRONLY | O_CREAT | O_APPEND, O_RDWR}) {
    EXPECT_NE(ErrorMessage([&] { OpenRegular(fifo, flags); }).find("it is a pipe"),
              std::string::npos);
  }
  EXPECT_NE(ErrorMessage([&] { ReadFile(fifo); }).find(fifo.string()), std::string::npos);
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  ASSERT_EQ(write(ends[1], "{}", 2), 2);
  close(ends[1]);
  EXPECT_EQ(ReadFile("/dev/fd/" + std::to_string(ends[0])), "{}") << "a shell's <(...)";
  close(ends[0]);
}

TEST(Files, OpenRegularMakesAndAppends) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "x";
  for (const char* word : {"one ", "two"}) {
    const Descriptor file = OpenRegular(path, O_WRONLY | O_CREAT | O_APPEND);
    ASSERT_EQ(write(file.get(), word, std::strlen(word)), static_cast<ssize_t>(std::strlen(word)));
  }
  EXPECT_EQ(ReadFile(path), "one two");
  EXPECT_THROW(OpenRegular(folder.path(), O_RDONLY), Error);
  EXPECT_THROW(OpenRegular(folder.path() / "absent", O_RDONLY), Error);
}

TEST(Files, ReplaceFileSurvivesWhatAKilledProcessLeft) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "accounting.json";
  ReplaceFile(path, "old");
  ASSERT_EQ(mkfifo((path.string() + ".new").c_str(), 0600), 0);
  ReplaceFile(path, "new");
  EXPECT_EQ(ReadFile(path), "new");
  EXPECT_EQ(FilesIn(folder.path()), 1);
}

}  // namespace
}  // namespace shoal
