// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/suspension.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "common/base/files.h"
#include "launch/processes/child_process.h"
#include "tests/launch/wait_until.h"
#include "tests/support/processes.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

// A process of its own that has a child: prepares, starts it, and leaves with what `body` returns.
class Family {
 public:
  Family(const std::filesystem::path& folder, void (*prepare)(), int (*body)()) {
    const std::filesystem::path child_file = folder / "child";
    pid_ = fork();
    if (pid_ == 0) {
      prepare();
      ProcessSpec spec;
      spec.command = {"/bin/sleep", "60"};
      spec.output = folder / "log";
      const ChildProcess child(spec);
      WriteFileAtomically(child_file, std::to_string(child.pid()));
      const int result = body();
      kill(child.pid(), SIGKILL);
      _exit(result);
    }
    EXPECT_TRUE(WaitUntil([&] { return std::filesystem::exists(child_file); }));
    child_ = std::stoi(ReadFile(child_file));
  }
  ~Family() {
    for (const pid_t one : {child_, pid_}) kill(one, SIGKILL);
    if (!left_) waitpid(pid_, nullptr, 0);
  }
  Family(const Family&) = delete;
  Family& operator=(const Family&) = delete;

  // Its exit code; -1 when it has not left in time.
  int Leave() {
    int status = 0;
    left_ = WaitUntil([&] { return waitpid(pid_, &status, WNOHANG) == pid_; });
    return left_ && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  pid_t pid() const { return pid_; }
  pid_t child() const { return child_; }

 private:
  pid_t pid_ = -1, child_ = -1;
  bool left_ = false;
};

void Wait() { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }

TEST(Suspension, StopsAndContinuesTheChildrenToo) {
  const TemporaryFolder folder;
  Family family(folder.path(), SuspendWithChildren, [] {
    while (Suspensions() == 0) Wait();
    const SteadyTime now = Now();
    return now - AwakeNow() > std::chrono::milliseconds(1) ? 7 : 8;
  });
  kill(family.pid(), SIGTSTP);
  EXPECT_TRUE(WaitUntil([&] { return ProcessState(family.pid()) == 'T'; }));
  EXPECT_TRUE(WaitUntil([&] { return ProcessState(family.child()) == 'T'; }));
  const SteadyTime stopped = Now();
  EXPECT_TRUE(WaitUntil([&] { return Now() - stopped > std::chrono::milliseconds(5); }));
  kill(family.pid(), SIGCONT);
  EXPECT_TRUE(WaitUntil([&] { return ProcessState(family.child()) != 'T'; }));
  EXPECT_EQ(family.Leave(), 7);
}

TEST(Suspension, IsRefusedAndCounted) {
  const TemporaryFolder folder;
  Family family(folder.path(), RefuseSuspension, [] {
    while (RefusedSuspensions() == 0) Wait();
    return Suspensions() == 0 ? 7 : 8;
  });
  kill(family.pid(), SIGTSTP);
  EXPECT_EQ(family.Leave(), 7) << "it has not been stopped";
}

TEST(Suspension, LeavesAnIgnoredSignalIgnored) {
  const TemporaryFolder folder;
  Family family(
      folder.path(),
      [] {
        signal(SIGTSTP, SIG_IGN);
        SuspendWithChildren();
      },
      [] {
        kill(getpid(), SIGTSTP);
        return Suspensions() == 0 ? 7 : 8;
      });
  EXPECT_EQ(family.Leave(), 7);
}

}  // namespace
}  // namespace shoal::launch
