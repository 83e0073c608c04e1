// SPDX-License-Identifier: Apache-2.0
// Membership of processes in a run, held by the kernel: each process holds a shared lock on
// RUN/.members, which is released when it ends for whatever reason. Two coordinators cannot run one
// run (RunFolder). With this lock the second one detects processes that a killed first one has left
// behind and that still store their records.
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
