// SPDX-License-Identifier: Apache-2.0
// A lock on a file. The lock ends when its FileLock is destroyed or the process ends.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>

#include "common/base/descriptor.h"

namespace shoal {

enum class Holding {
  kAlone,       // excludes all other holders
  kWithOthers,  // excludes holders of kAlone
};

// Uses locks of the open file description (F_OFD_SETLK). Such a lock also excludes a second opening
// of the file in the same process, stays when the process closes another descriptor of the file,
// and can be queried without being taken. If a network file system supports locks, the lock applies
// to all hosts.
class FileLock {
 public:
  // Takes the lock, and creates the file if it does not exist (permissions follow the umask).
  // Returns empty if another holder has the lock. Throws Error naming the file if the file cannot
  // be written or is not a regular file.
  static std::optional<FileLock> Take(const std::filesystem::path& file,
                                      Holding holding = Holding::kAlone);
  // Tries to take the lock until `deadline` has passed since the call. Otherwise like Take above.
  static std::optional<FileLock> Take(const std::filesystem::path& file, Holding holding,
                                      std::chrono::milliseconds deadline);

 private:
  explicit FileLock(Descriptor file) : file_(std::move(file)) {}

  Descriptor file_;
};

// Whether any process holds a lock on the file; false if the file does not exist.
bool IsLocked(const std::filesystem::path& file);

}  // namespace shoal
