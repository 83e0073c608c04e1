// SPDX-License-Identifier: Apache-2.0
// Runs one of the built programs on a pseudo-terminal.
#pragma once

#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>
#include <utmp.h>  // login_tty

#include <chrono>
#include <csignal>
#include <string>
#include <vector>

#include "common/base/clock.h"
#include "tests/support/paths.h"

namespace shoal {

class TerminalProgram {
 public:
  // command[0] is a program's name in the build's bin folder. `kind`: value of TERM.
  explicit TerminalProgram(const std::vector<std::string>& command, const char* kind = "xterm")
      : TerminalProgram(ProgramPath(command[0]), {command.begin() + 1, command.end()}, kind) {}
  // `program`: path of the program.
  TerminalProgram(const std::string& program, const std::vector<std::string>& arguments,
                  const char* kind = "xterm") {
    winsize size{.ws_row = 24, .ws_col = 100, .ws_xpixel = 0, .ws_ypixel = 0};
    EXPECT_EQ(openpty(&own_end_, &its_end_, nullptr, nullptr, &size), 0);
    tcgetattr(its_end_, &before_);
    std::vector<std::string> command{program};
    command.insert(command.end(), arguments.begin(), arguments.end());
    std::vector<char*> words;
    for (std::string& word : command) words.push_back(word.data());
    words.push_back(nullptr);
    pid_ = fork();
    if (pid_ != 0) return;
    login_tty(its_end_);
    setenv("TERM", kind, 1);
    execv(words[0], words.data());
    _exit(127);
  }
  ~TerminalProgram() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    close(own_end_);
    close(its_end_);
  }
  TerminalProgram(const TerminalProgram&) = delete;
  TerminalProgram& operator=(const TerminalProgram&) = delete;

  void Type(const std::string& keys) {
    EXPECT_EQ(write(own_end_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
  }
  void Signal(int signal) { kill(pid_, signal); }

  // Reads until `text` appears after the text that the last call found. Returns false at the
  // deadline.
  bool WaitFor(const std::string& text, std::chrono::seconds deadline) {
    const SteadyTime end = Now() + deadline;
    while (Now() < end) {
      const size_t at = shown_.find(text);
      if (at != std::string::npos) {
        shown_.erase(0, at + text.size());
        return true;
      }
      Read();
    }
    return false;
  }
  const std::string& shown() const { return shown_; }

  // The exit code in the form of shells: 128 + the signal's number if a signal killed the program.
  // -1 at the deadline.
  int End(std::chrono::seconds deadline) {
    const SteadyTime end = Now() + deadline;
    int status = 0;
    while (Now() < end) {
      Read();
      if (waitpid(pid_, &status, WNOHANG) != pid_) continue;
      pid_ = -1;
      return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    return -1;
  }
  // Whether the terminal's settings are the same as before the program's start.
  bool LeftAsItWas() const {
    termios now{};
    tcgetattr(its_end_, &now);
    return now.c_lflag == before_.c_lflag && now.c_cc[VQUIT] == before_.c_cc[VQUIT];
  }

 private:
  void Read() {
    pollfd end{.fd = own_end_, .events = POLLIN, .revents = 0};
    if (poll(&end, 1, 20) <= 0) return;
    char buffer[4096];
    const ssize_t n = read(own_end_, buffer, sizeof(buffer));
    if (n > 0) shown_.append(buffer, static_cast<size_t>(n));
  }

  int own_end_ = -1, its_end_ = -1;
  pid_t pid_ = -1;
  termios before_{};
  std::string shown_;
};

}  // namespace shoal
