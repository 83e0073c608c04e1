// SPDX-License-Identifier: Apache-2.0
// A folder that is removed together with its owner, and everything in it. A process that is killed
// cannot remove its folders: the next one that makes a scratch folder in the same parent does.
#pragma once

#include <filesystem>
#include <optional>
#include <utility>

#include "common/base/file_lock.h"

namespace shoal::launch {

class ScratchFolder {
 public:
  // Made in `parent`, where folders of killed processes of this user are removed first. Throws
  // Error naming the folder when it cannot be made.
  explicit ScratchFolder(
      const std::filesystem::path& parent = std::filesystem::temp_directory_path());
  // RUN/.scratch.tmp-PID, one of a process at a time: where its owner is killed, it goes with the
  // run's other unfinished files (run_leftovers.h). Throws Error.
  static ScratchFolder WithinRun(const std::filesystem::path& run);
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  struct Made {};
  ScratchFolder(std::filesystem::path path, Made) : path_(std::move(path)) {}

  std::filesystem::path path_;
  std::optional<FileLock> owner_;  // of PATH/.owner: free as soon as the process is gone
};

}  // namespace shoal::launch
