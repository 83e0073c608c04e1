// SPDX-License-Identifier: Apache-2.0
// Membership of processes in a run. Each process holds a shared lock on RUN/.members; the kernel
// releases the lock when the process ends, for whatever reason. RunFolder prevents two coordinators
// in one run. If a coordinator was killed, the next coordinator uses this lock to detect processes
// of the killed coordinator that still store records.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>

#include "common/base/descriptor.h"

namespace shoal {

// A process keeps this object as long as it works on the run. Uses F_SETLK instead of the open-file
// locks of FileLock, because AnyMember needs the holder's pid, which the kernel reports only for
// F_SETLK. A process may have only one RunMembership, because closing any descriptor of the file
// releases the lock.
class RunMembership {
 public:
  // Throws Error if the file cannot be written.
  explicit RunMembership(const std::filesystem::path& run);

 private:
  Descriptor file_;
};

// The pid of a process that is a member of the run; empty if there is no member. Members must not
// call this function.
std::optional<pid_t> AnyMember(const std::filesystem::path& run);

}  // namespace shoal
