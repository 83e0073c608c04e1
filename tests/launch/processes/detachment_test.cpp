// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/detachment.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/stop.h"
#include "tests/launch/wait_until.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

// A process that detaches `body` and exits with the exit code that the parent received. `body` gets
// the detachment and returns the exit code of the detached process.
pid_t Launch(const std::function<int(Detachment&)>& body) {
  const pid_t pid = fork();
  if (pid != 0) return pid;
  InstallStopSignals();
  Detachment detachment;
  _exit(detachment.IsChild() ? body(detachment) : detachment.exit_code());
}

int ExitCodeOfProcess(pid_t pid) {
  int status = 0;
  EXPECT_EQ(waitpid(pid, &status, 0), pid);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Detachment, TheParentReturnsWhenTheChildHasStartedAndTheChildGoesOn) {
  const TemporaryFolder folder;
  const auto log = folder.path() / "log", done = folder.path() / "done";
  const pid_t parent = Launch([&](Detachment& detachment) {
    detachment.Started(log);
    std::printf("from the child, session %d\n", getsid(0) == getpid());
    std::fflush(stdout);
    while (!std::filesystem::exists(folder.path() / "go")) usleep(1000);
    WriteFileAtomically(done, "x");
    return 5;
  });
  EXPECT_EQ(ExitCodeOfProcess(parent), 0);
  EXPECT_FALSE(std::filesystem::exists(done));
  WriteFileAtomically(folder.path() / "go", "");
  EXPECT_TRUE(WaitUntil([&] { return std::filesystem::exists(done); }));
  EXPECT_EQ(ReadFile(log), "from the child, session 1\n");
}

TEST(Detachment, AChildThatDoesNotStartGivesItsExitCode) {
  EXPECT_EQ(ExitCodeOfProcess(Launch([](Detachment&) { return 2; })), 2);
  EXPECT_EQ(ExitCodeOfProcess(Launch([](Detachment&) -> int {
              raise(SIGKILL);
              return 0;
            })),
            1);
}

TEST(Detachment, AChildThatNeverStartsIsNotWaitedForBeyondTheDeadline) {
  const TemporaryFolder folder;
  const auto gone = folder.path() / "gone";
  const pid_t parent = fork();
  if (parent == 0) {
    InstallStopSignals();
    Detachment detachment(std::chrono::seconds(0));
    if (!detachment.IsChild()) _exit(detachment.exit_code());
    WriteFileAtomically(gone, "");
    _exit(0);
  }
  EXPECT_EQ(ExitCodeOfProcess(parent), 1);
  EXPECT_TRUE(WaitUntil([&] { return std::filesystem::exists(gone); })) << "it was left alone";
}

TEST(Detachment, UntilItHasStartedTheParentHandsStopSignalsOn) {
  const TemporaryFolder folder;
  const auto waits = folder.path() / "waits";
  const pid_t parent = Launch([&](Detachment&) {
    WriteFileAtomically(waits, "");
    while (!StopRequested()) usleep(1000);
    return 7;
  });
  EXPECT_TRUE(WaitUntil([&] { return std::filesystem::exists(waits); }));
  kill(parent, SIGINT);
  EXPECT_EQ(ExitCodeOfProcess(parent), 7);
}

TEST(Detachment, AChildThatDiesByTheSignalThatWasHandedOnWasStoppedInOrder) {
  const TemporaryFolder folder;
  const auto waits = folder.path() / "waits";
  const pid_t parent = Launch([&](Detachment&) {
    signal(SIGTERM, SIG_DFL);
    WriteFileAtomically(waits, "");
    while (true) pause();
    return 0;
  });
  EXPECT_TRUE(WaitUntil([&] { return std::filesystem::exists(waits); }));
  kill(parent, SIGINT);
  EXPECT_EQ(ExitCodeOfProcess(parent), kInterruptedExit);
}

TEST(Detachment, ALogThatCannotBeOpenedIsNamed) {
  const pid_t parent = Launch([](Detachment& detachment) {
    try {
      detachment.Started("/absent/log");
    } catch (const Error& e) {
      return std::string(e.what()).find("/absent/log") == std::string::npos ? 3 : 9;
    }
    return 0;
  });
  EXPECT_EQ(ExitCodeOfProcess(parent), 9);
}

}  // namespace
}  // namespace shoal::launch
