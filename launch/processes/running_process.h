// SPDX-License-Identifier: Apache-2.0
// One started process of a run: a child process, or threads of this process
// (launch/run/in_process_roles.h).
#pragma once

#include <sys/types.h>

#include <functional>
#include <memory>
#include <optional>

#include "launch/processes/child_process.h"

namespace shoal::launch {

// One thread. The destructor ends a process that still runs.
class RunningProcess {
 public:
  virtual ~RunningProcess() = default;
  // The pid in the process's reports.
  virtual pid_t pid() const = 0;
  // The exit status if the process has ended, else empty; does not wait.
  virtual std::optional<ExitStatus> Poll() = 0;
  // Does nothing if the process has ended.
  virtual void Signal(int signal) = 0;
};

// Starts a process. Throws Error if the process cannot be started.
using ProcessStarter = std::function<std::unique_ptr<RunningProcess>(const ProcessSpec&)>;

// Starts a child process.
std::unique_ptr<RunningProcess> StartChild(const ProcessSpec& spec);

}  // namespace shoal::launch
