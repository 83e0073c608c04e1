// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/child_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/launch/wait_until.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StrEq;

class ChildProcessTest : public ::testing::Test {
 protected:
  ProcessSpec Shell(const std::string& script) const {
    ProcessSpec spec;
    spec.role = "fake";
    spec.command = {"/bin/sh", "-c", script};
    spec.output = folder_.path() / "out";
    return spec;
  }
  std::optional<ExitStatus> Wait(ChildProcess& child) const {
    EXPECT_TRUE(WaitUntil([&] { return child.Poll().has_value(); }));
    return child.Poll();
  }
  std::string Output() const { return ReadFile(folder_.path() / "out"); }

  TemporaryFolder folder_;
};

// Running, and not a zombie.
bool Alive(pid_t pid) {
  std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
  std::string number, name, state;
  return stat >> number >> name >> state && state != "Z" && state != "X";
}

// A child, alive, of a process that has just been killed.
pid_t OrphanOf(const ProcessSpec& spec) {
  int ends[2];
  EXPECT_EQ(pipe(ends), 0);
  const pid_t parent = fork();
  if (parent == 0) {
    const ChildProcess child(spec);
    const pid_t pid = child.pid();
    if (write(ends[1], &pid, sizeof pid) != sizeof pid) _exit(1);
    while (true) pause();
  }
  pid_t orphan = 0;
  EXPECT_EQ(read(ends[0], &orphan, sizeof orphan), ssize_t{sizeof orphan});
  EXPECT_TRUE(Alive(orphan));
  kill(parent, SIGKILL);
  waitpid(parent, nullptr, 0);
  close(ends[0]);
  close(ends[1]);
  return orphan;
}

TEST_F(ChildProcessTest, ReadsItsInputFromAFile) {
  WriteFileAtomically(folder_.path() / "in", "from a file");
  ProcessSpec spec = Shell("cat");
  spec.input = folder_.path() / "in";
  ChildProcess child(spec);
  Wait(child);
  EXPECT_EQ(Output(), "from a file");
}

TEST_F(ChildProcessTest, TheInputItHoldsEndsWithIt) {
  ProcessSpec spec = Shell("exec 3<&0; (cat; echo end) <&3 3<&- & echo $!; exec sleep 100 3<&-");
  spec.holds_input = true;
  std::optional<ChildProcess> child(spec);
  ASSERT_TRUE(WaitUntil([&] { return !LastLine(spec.output).empty(); }));
  const pid_t reader = std::stoi(LastLine(spec.output));
  EXPECT_TRUE(Alive(reader));
  child.reset();
  EXPECT_TRUE(WaitUntil([&] { return LastLine(spec.output) == "end"; }));
}

TEST_F(ChildProcessTest, ReportsTheExitCode) {
  ChildProcess child(Shell("exit 7"));
  const auto status = Wait(child);
  EXPECT_FALSE(status->by_signal);
  EXPECT_EQ(status->code, 7);
  EXPECT_FALSE(status->Clean());
  EXPECT_EQ(status->Describe(), "exit code 7");
}

TEST_F(ChildProcessTest, ReportsTheSignal) {
  ChildProcess child(Shell("kill -9 $$"));
  EXPECT_EQ(Wait(child)->Describe(), "killed by SIGKILL");
}

TEST_F(ChildProcessTest, AppendsBothOutputsToTheFile) {
  WriteFileAtomically(folder_.path() / "out", "before\n");
  ChildProcess child(Shell("echo out; echo err >&2"));
  Wait(child);
  EXPECT_THAT(Output(), StrEq("before\nout\nerr\n"));
}

TEST_F(ChildProcessTest, SeparatesErrorsWhenAsked) {
  ProcessSpec spec = Shell("echo out; echo err >&2");
  spec.errors = folder_.path() / "err";
  ChildProcess child(spec);
  Wait(child);
  EXPECT_EQ(Output(), "out\n");
  EXPECT_EQ(ReadFile(spec.errors), "err\n");
}

TEST_F(ChildProcessTest, AddsToTheEnvironmentAndReplacesInIt) {
  setenv("SHOAL_TEST_KEPT", "kept", 1);
  setenv("SHOAL_TEST_REPLACED", "old", 1);
  ProcessSpec spec = Shell("");
  spec.command = {"/usr/bin/env"};  // a shell would hide duplicates
  spec.environment = {{"SHOAL_TEST_ADDED", "added"}, {"SHOAL_TEST_REPLACED", "new"}};
  ChildProcess child(spec);
  Wait(child);
  const std::string output = Output();
  for (const char* line :
       {"SHOAL_TEST_KEPT=kept\n", "SHOAL_TEST_ADDED=added\n", "SHOAL_TEST_REPLACED=new\n"}) {
    EXPECT_THAT(output, HasSubstr(line));
  }
  EXPECT_THAT(output, Not(HasSubstr("SHOAL_TEST_REPLACED=old")));
}

TEST_F(ChildProcessTest, HasAProcessGroupOfItsOwn) {
  ChildProcess child(Shell("read line; sleep 60"));
  EXPECT_TRUE(WaitUntil([&] { return getpgid(child.pid()) == child.pid(); }));
}

TEST_F(ChildProcessTest, NamesAProgramThatDoesNotExist) {
  ProcessSpec spec = Shell("");
  spec.command[0] = "/absent/program";
  try {
    ChildProcess child(spec);
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("/absent/program"), HasSubstr("No such file")));
  }
}

TEST_F(ChildProcessTest, NamesALogThatCannotBeWritten) {
  ProcessSpec spec = Shell("");
  spec.output = "/absent/log";
  EXPECT_THROW(ChildProcess child(spec), Error);
}

TEST_F(ChildProcessTest, IsKilledWithItsOwner) {
  pid_t pid = 0;
  {
    ChildProcess child(Shell("trap '' TERM; while true; do sleep 60; done"));
    pid = child.pid();
    EXPECT_TRUE(Alive(pid));
  }
  EXPECT_FALSE(Alive(pid));
}

TEST_F(ChildProcessTest, EndsWhenItsParentIsKilled) {
  const pid_t orphan = OrphanOf(Shell("exec sleep 60"));
  EXPECT_TRUE(WaitUntil([&] { return !Alive(orphan); }));
}

TEST_F(ChildProcessTest, GoesOnWithoutItsParentWhenAsked) {
  ProcessSpec spec = Shell("exec sleep 60");
  spec.outlives_parent = true;
  const pid_t orphan = OrphanOf(spec);
  const pid_t other = OrphanOf(Shell("exec sleep 60"));
  EXPECT_TRUE(WaitUntil([&] { return !Alive(other); }));
  EXPECT_TRUE(Alive(orphan));
  kill(orphan, SIGKILL);
}

TEST_F(ChildProcessTest, RunToEndReturnsTheStatus) {
  const auto status = RunToEnd(Shell("exit 3"), std::chrono::seconds(10), [] { return false; });
  ASSERT_TRUE(status.has_value());
  EXPECT_EQ(status->code, 3);
}

TEST_F(ChildProcessTest, RunToEndStopsAtTheDeadlineAndWhenAsked) {
  EXPECT_FALSE(RunToEnd(Shell("sleep 60"), std::chrono::seconds(0), [] { return false; }));
  EXPECT_FALSE(RunToEnd(Shell("sleep 60"), std::chrono::seconds(60), [] { return true; }));
}

TEST_F(ChildProcessTest, LastLineSkipsBlankOnes) {
  const auto file = folder_.path() / "log";
  EXPECT_EQ(LastLine(file), "");
  WriteFileAtomically(file, "first\nlast\n  \n\n");
  EXPECT_EQ(LastLine(file), "last");
  WriteFileAtomically(file, std::string(10'000, 'x') + "\nlast without end");
  EXPECT_EQ(LastLine(file), "last without end");
}

TEST_F(ChildProcessTest, AProgramsErrorIsItsLastLineWithItsKind) {
  const auto errors = folder_.path() / "errors";
  WriteFileAtomically(errors, "filming\nshoal: error: no such run\n");
  const auto error = [&](ExitStatus status) { return ProgramError("shoal", status, errors); };
  EXPECT_STREQ(error({.code = 2}).what(), "shoal: no such run");
  EXPECT_EQ(error({.code = 2}).exit_code(), 2);
  EXPECT_EQ(error({.code = 1}).exit_code(), 1);
  const Error killed = error({.by_signal = true, .code = 2});
  EXPECT_EQ(killed.exit_code(), 1);
  EXPECT_THAT(killed.what(), testing::HasSubstr("killed by SIGINT"));
  WriteFileAtomically(errors, "");
  EXPECT_THAT(error({.code = 3}).what(), testing::HasSubstr("exit code 3"));
}

}  // namespace
}  // namespace shoal::launch
