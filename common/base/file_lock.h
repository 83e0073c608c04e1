// SPDX-License-Identifier: Apache-2.0
// A lock on a file, which ends with its holder: at destruction, or with the process.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>

#include "common/base/descriptor.h"

namespace shoal {

enum class Holding {
  kAlone,       // excludes all other holders
  kWithOthers,  // excludes a holder of kAlone
};

// Locks of the open file (F_OFD_SETLK): they also hold between two openings within one process, are
// not lost when another descriptor of the file is closed, can be asked for without being taken, and
// reach the other hosts of a network file system that has locks.
class FileLock {
 public:
  // Makes the file if it does not exist (its permissions as the umask allows). Empty if another
  // process holds the lock. Throws Error naming the file if it cannot be written or is no file.
  static std::optional<FileLock> Take(const std::filesystem::path& file,
                                      Holding holding = Holding::kAlone);
  // Asks again until the deadline.
  static std::optional<FileLock> Take(const std::filesystem::path& file, Holding holding,
                                      std::chrono::milliseconds deadline);

 private:
  explicit FileLock(Descriptor file) : file_(std::move(file)) {}

  Descriptor file_;
};

// Whether anybody holds a lock of the file; false without the file.
bool IsLocked(const std::filesystem::path& file);

}  // namespace shoal
