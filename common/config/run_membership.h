// SPDX-License-Identifier: Apache-2.0
// Membership of processes in a run. Each process holds a shared lock on RUN/.members; the kernel
// releases the lock when the process ends, for whatever reason. RunFolder prevents two coordinators
// in one run. If a coordinator was killed, the next one uses this lock to detect processes of the
// first one that still store records.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>

#include "common/base/descriptor.h"

namespace shoal {

// Held for as long as the process works on the run. Uses F_SETLK, not the open-file locks of
// FileLock: the kernel reports the holder's pid only for F_SETLK, and AnyMember names a process. A
// process may have only one, because closing any descriptor of the file releases the lock.
class RunMembership {
 public:
  // Throws Error when the file cannot be written.
  explicit RunMembership(const std::filesystem::path& run);

 private:
  Descriptor file_;
};

// A process that is a member of the run; empty if there is none. Members must not call it.
std::optional<pid_t> AnyMember(const std::filesystem::path& run);

}  // namespace shoal
