// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/detachment.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <utility>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/pipe.h"
#include "common/base/sleep.h"
#include "common/base/stop.h"

namespace shoal::launch {
namespace {

constexpr int kPollMs = 100;
// Time for a child to end after its end of the pipe was closed (exit closes the pipe).
constexpr std::chrono::seconds kReapChild{30};

int Redirect(const char* file, int flags, int to) {
  const Descriptor opened(open(file, flags | O_CLOEXEC, 0600));
  if (opened.get() < 0) throw RuntimeError("cannot open '{}': {}", file, std::strerror(errno));
  return dup2(opened.get(), to);
}

}  // namespace

Detachment::Detachment(std::chrono::seconds deadline) : deadline_(deadline) {
  Pipe pipe;
  std::fflush(nullptr);  // otherwise both processes would write the buffer
  child_ = fork();
  if (child_ < 0) throw RuntimeError("cannot detach: fork: {}", std::strerror(errno));
  if (child_ == 0) {
    to_parent_ = std::move(pipe.write);
    setsid();  // without a terminal: no SIGINT or SIGHUP from it
    return;
  }
  pipe.write.Close();  // then only the child holds the write end
  exit_code_ = WaitForChild(pipe.read.get());
}

int Detachment::WaitForChild(int from_child) {
  const SteadyTime deadline = Now() + deadline_;
  int handed_on = 0;
  while (Now() < deadline) {
    for (; handed_on < StopRequests(); ++handed_on) kill(child_, SIGTERM);
    pollfd end{.fd = from_child, .events = POLLIN, .revents = 0};
    if (poll(&end, 1, kPollMs) <= 0) continue;
    char word = 0;
    if (read(from_child, &word, 1) == 1) return 0;  // the child has started
    return Reap();                                  // end of file: the child has ended
  }
  std::fprintf(
      stderr, "shoal: the run has not started within %d s; process %d goes on trying: shoal runs\n",
      static_cast<int>(deadline_.count()), child_);
  return 1;
}

int Detachment::Reap() const {
  const SteadyTime deadline = Now() + kReapChild;
  int status = 0;
  while (waitpid(child_, &status, WNOHANG) != child_) {
    if (Now() > deadline) return 1;
    SleepFor(std::chrono::milliseconds(1));
  }
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  // The forwarded signal stopped the child.
  return WTERMSIG(status) == SIGTERM && StopRequested() ? kInterruptedExit : 1;
}

void Detachment::Started(const std::filesystem::path& log) {
  std::fflush(nullptr);
  Redirect(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, STDOUT_FILENO);
  Redirect(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, STDERR_FILENO);
  Redirect("/dev/null", O_RDONLY, STDIN_FILENO);
  const char word = 1;
  [[maybe_unused]] const ssize_t written =
      write(to_parent_.get(), &word, 1);  // fails if the parent has exited
  to_parent_.Close();
}

}  // namespace shoal::launch
