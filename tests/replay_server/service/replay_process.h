// SPDX-License-Identifier: Apache-2.0
// shoal-replay in a separate process, whose output is written to a file.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/base/clock.h"
#include "common/base/files.h"
#include "tests/support/paths.h"

namespace shoal::replay {

class ReplayProcess {
 public:
  ReplayProcess(std::vector<std::string> arguments, const std::filesystem::path& errors)
      : errors_(errors) {
    arguments.insert(arguments.begin(), ProgramPath("shoal-replay"));
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ != 0) return;
    const int fd = open(errors.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    dup2(fd, STDERR_FILENO);
    dup2(fd, STDOUT_FILENO);
    execv(argv[0], argv.data());
    _exit(127);
  }
  ~ReplayProcess() {
    if (pid_ > 0) Kill();
  }
  ReplayProcess(const ReplayProcess&) = delete;
  ReplayProcess& operator=(const ReplayProcess&) = delete;

  void Signal(int signal) { kill(pid_, signal); }
  void Kill() {
    Signal(SIGKILL);
    waitpid(pid_, nullptr, 0);
    pid_ = -1;
  }
  // The exit code in the form of shells: 128 + the signal's number if a signal killed the process.
  // Empty if the process does not end before the deadline.
  std::optional<int> ExitCode(std::chrono::seconds deadline) {
    const SteadyTime end = Now() + deadline;
    int status = 0;
    while (waitpid(pid_, &status, WNOHANG) == 0) {
      if (Now() > end) return std::nullopt;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));  // a poll with a deadline
    }
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  std::string Errors() const { return ReadFile(errors_); }

 private:
  const std::filesystem::path errors_;
  pid_t pid_ = -1;
};

}  // namespace shoal::replay
