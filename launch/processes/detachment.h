// SPDX-License-Identifier: Apache-2.0
// A process that goes on in the background after the command that started it has returned.
#pragma once

#include <chrono>
#include <filesystem>

#include "common/base/descriptor.h"

namespace shoal::launch {

// Splits this process in two before it has threads: the child goes on in a session of its own, the
// parent waits until the child says that it has started.
class Detachment {
 public:
  // Returns in the child, and in the parent once the child has started or ended, or at the
  // deadline, which leaves the child alone. Until then the parent hands SIGINT and SIGTERM on to
  // the child. Throws Error.
  explicit Detachment(std::chrono::seconds deadline = kStartDeadline);
  Detachment(const Detachment&) = delete;
  Detachment& operator=(const Detachment&) = delete;

  bool IsChild() const { return child_ == 0; }
  // Parent: 0 once the child has started, else its exit code; kInterruptedExit (stop.h) where a
  // signal that was handed on stopped it; 1 at the deadline.
  int exit_code() const { return exit_code_; }
  // Child: it has started. From now on stdout and stderr go to the end of `log`, stdin is empty,
  // and the parent returns. Throws Error when the log cannot be opened.
  void Started(const std::filesystem::path& log);

  // Former processes, hosts and a large replay file are waited for while a run starts.
  static constexpr std::chrono::seconds kStartDeadline{1800};

 private:
  int WaitForChild(int from_child);
  int Reap() const;

  const std::chrono::seconds deadline_;
  int child_ = 0;         // process id; 0 in the child
  Descriptor to_parent_;  // the child's end of the pipe
  int exit_code_ = 0;
};

}  // namespace shoal::launch
