// SPDX-License-Identifier: Apache-2.0
// A folder that the destructor of this object removes, with its content. If a process is killed,
// its folders are removed by the next process that makes a scratch folder in the same parent.
#pragma once

#include <filesystem>
#include <optional>
#include <utility>

#include "common/base/file_lock.h"

namespace shoal::launch {

class ScratchFolder {
 public:
  // Removes the folders of this user's killed processes from `parent`, then creates the folder
  // there. If the folder cannot be created, throws Error naming the folder.
  explicit ScratchFolder(
      const std::filesystem::path& parent = std::filesystem::temp_directory_path());
  // Creates RUN/.scratch.tmp-PID. A process may have one such folder at a time. If the process is
  // killed, the folder is removed with the run's other unfinished files (run_leftovers.h). Throws
  // Error.
  static ScratchFolder WithinRun(const std::filesystem::path& run);
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  struct Made {};
  ScratchFolder(std::filesystem::path path, Made) : path_(std::move(path)) {}

  std::filesystem::path path_;
  std::optional<FileLock> owner_;  // lock of PATH/.owner; released when the process ends
};

}  // namespace shoal::launch
