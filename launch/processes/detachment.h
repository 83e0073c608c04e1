// SPDX-License-Identifier: Apache-2.0
// A process that continues in the background after the command that started it has returned.
#pragma once

#include <chrono>
#include <filesystem>

#include "common/base/descriptor.h"

namespace shoal::launch {

// Forks this process, which must not have threads yet. The child continues in its own session; the
// parent waits until the child reports its start.
class Detachment {
 public:
  // Returns in the child at once. Returns in the parent after the child has started or ended, or at
  // the deadline; the child continues after the deadline. While the parent waits, it forwards
  // SIGINT and SIGTERM to the child. Throws Error.
  explicit Detachment(std::chrono::seconds deadline = kStartDeadline);
  Detachment(const Detachment&) = delete;
  Detachment& operator=(const Detachment&) = delete;

  bool IsChild() const { return child_ == 0; }
  // The result in the parent: 0 if the child has started, 1 at the deadline, else the child's exit
  // code; kInterruptedExit (stop.h) if a forwarded signal stopped the child.
  int exit_code() const { return exit_code_; }
  // Call it in the child. Reports the start to the parent, which then returns. From now on stdout
  // and stderr are appended to `log`, and stdin is empty. Throws Error if the log cannot be opened.
  void Started(const std::filesystem::path& log);

  // The start of a run may wait for processes of an earlier run, for hosts and for a large replay
  // file.
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
