// SPDX-License-Identifier: Apache-2.0
// One program running as a child of this process.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/descriptor.h"
#include "common/base/error.h"
#include "common/wire/process_name.h"

namespace shoal::launch {

struct ProcessSpec {
  std::string role;                                              // "actor", "replay", ...
  int id = 0;                                                    // number within the role
  std::vector<std::string> command;                              // [0] is the program's path
  std::vector<std::pair<std::string, std::string>> environment;  // added to this process's
  std::filesystem::path input;   // file for stdin; empty = /dev/null
  std::filesystem::path output;  // file to which stdout and stderr are appended
  std::filesystem::path errors;  // file for stderr; empty = output
  bool outlives_parent = false;  // gets no SIGHUP when this process dies
  bool holds_input = false;      // stdin is a pipe, which this process keeps open
  bool elsewhere = false;        // a remote shell: its exit code 255 is a lost connection
  bool expendable = false;       // the run continues without the process (supervisor.h)
  std::vector<int> cores = {};   // allowed CPUs; empty = the CPUs of this process

  std::string Name() const {
    return ProcessName{.role = role, .index = static_cast<uint32_t>(id)}.Text();
  }
};

struct ExitStatus {
  bool by_signal = false;
  int code = 0;  // exit code, or the signal's number

  bool Clean() const { return !by_signal && code == 0; }
  // The exit status in the form of shells: 128 + the signal's number if a signal ended the process.
  // A program that Ctrl-C ended in order has 130 (common/base/main_guard.h).
  int ShellCode() const { return by_signal ? 128 + code : code; }
  // "exit code 1", "killed by SIGKILL"
  std::string Describe() const;
};

// Owns the child. The destructor kills and reaps a running child, and waits at most five seconds
// for its end. Children get SIGHUP when this process dies. Each child has its own process group, so
// Ctrl-C on the terminal does not reach the child. Without `input` a child reads from /dev/null.
// Create and use the object on one thread that lives as long as the child, because the kernel sends
// SIGHUP when this thread ends.
class ChildProcess {
 public:
  // Throws Error naming the program or the file that could not be opened.
  explicit ChildProcess(const ProcessSpec& spec);
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&& other) noexcept;

  pid_t pid() const { return pid_; }
  // The exit status if the child has ended, else empty; does not wait.
  std::optional<ExitStatus> Poll();
  // Does nothing if the child has ended.
  void Signal(int signal);

 private:
  void KillAndReap();

  pid_t pid_ = -1;         // -1: moved from
  Descriptor held_input_;  // this process's end of the child's input
  std::optional<ExitStatus> ended_;
};

// Runs a program to its end. Calls `stop` about ten times a second. After `deadline`, or when
// `stop` returns true, sends SIGTERM, then SIGKILL, and returns empty.
std::optional<ExitStatus> RunToEnd(const ProcessSpec& spec, std::chrono::seconds deadline,
                                   const std::function<bool()>& stop);

// The error of a program that did not end cleanly: the last line of its standard error, without
// "PROGRAM: error: ". Exit code 2 gives a usage error; every other end gives a run-time error.
Error ProgramError(const std::string& program, const ExitStatus& status,
                   const std::filesystem::path& errors);

// The last non-blank line of a file, for messages; empty if there is no such line.
std::string LastLine(const std::filesystem::path& file);

}  // namespace shoal::launch
