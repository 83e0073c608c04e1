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
  int id = 0;                                                    // within the role
  std::vector<std::string> command;                              // [0] is the program's path
  std::vector<std::pair<std::string, std::string>> environment;  // added to our own
  std::filesystem::path input;   // stdin is read from it; empty = /dev/null
  std::filesystem::path output;  // stdout and stderr are appended to it
  std::filesystem::path errors;  // stderr, where apart; empty = output
  bool outlives_parent = false;  // gets no SIGHUP when this process dies
  bool holds_input = false;      // stdin is a pipe that closes when this process lets go of it
  bool elsewhere = false;        // a remote shell: its exit code 255 is a lost connection
  bool expendable = false;       // the run goes on without it (supervisor.h)
  std::vector<int> cores = {};   // CPUs it may run on; empty = those that we may

  std::string Name() const {
    return ProcessName{.role = role, .index = static_cast<uint32_t>(id)}.Text();
  }
};

struct ExitStatus {
  bool by_signal = false;
  int code = 0;  // exit code, or the signal's number

  bool Clean() const { return !by_signal && code == 0; }
  // The exit status as shells give it: 128 + the signal's number if a signal ended the process. 130
  // is the value of a program that Ctrl-C ended in order (common/base/main_guard.h).
  int ShellCode() const { return by_signal ? 128 + code : code; }
  // "exit code 1", "killed by SIGKILL"
  std::string Describe() const;
};

// Owns the child: one that still runs at destruction is killed and reaped, which
// is waited for five seconds at most. Children get SIGHUP
// when this process dies, have a process group of their own (Ctrl-C on the terminal does not reach
// them) and read from /dev/null unless told otherwise. Create and use on one thread that lives as
// long as the child: the kernel ties the death signal to it.
class ChildProcess {
 public:
  // Throws Error naming the program or the file that could not be opened.
  explicit ChildProcess(const ProcessSpec& spec);
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&& other) noexcept;

  pid_t pid() const { return pid_; }
  // Its end, once it has ended; does not wait.
  std::optional<ExitStatus> Poll();
  // Nothing happens once it has ended.
  void Signal(int signal);

 private:
  void KillAndReap();

  pid_t pid_ = -1;         // -1: moved from
  Descriptor held_input_;  // our end of the child's input
  std::optional<ExitStatus> ended_;
};

// Runs a program to its end. SIGTERM, then SIGKILL, after `deadline` or when `stop` says so (asked
// about ten times a second); empty when that happened.
std::optional<ExitStatus> RunToEnd(const ProcessSpec& spec, std::chrono::seconds deadline,
                                   const std::function<bool()>& stop);

// The error of a program that did not end cleanly: the last line of its standard error, without
// "PROGRAM: error: ". Exit code 2 gives a usage error, every other end a run-time error.
Error ProgramError(const std::string& program, const ExitStatus& status,
                   const std::filesystem::path& errors);

// The last line of a file that is not blank, for messages; empty when there is none.
std::string LastLine(const std::filesystem::path& file);

}  // namespace shoal::launch
