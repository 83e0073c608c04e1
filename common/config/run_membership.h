// SPDX-License-Identifier: Apache-2.0
// Which processes belong to a run, known to the kernel: each holds a shared lock on RUN/.members,
// which goes with the process however it ends. Two coordinators cannot run one run (RunFolder);
// this tells the second one of processes that the first, killed, has left behind and that are still
// storing what they have.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>

#include "common/base/descriptor.h"

namespace shoal {

// Held for as long as the process works on the run. A lock of the process (F_SETLK), not one of the
// open file as FileLock's: of those the kernel does not say who holds them, and AnyMember names a
// process. So it is one per process: closing any descriptor of the file would drop the lock.
class RunMembership {
 public:
  // Throws Error when the file cannot be written.
  explicit RunMembership(const std::filesystem::path& run);

 private:
  Descriptor file_;
};

// A process that is a member of the run; none when there is none. Not to be asked by a member.
std::optional<pid_t> AnyMember(const std::filesystem::path& run);

}  // namespace shoal
