// SPDX-License-Identifier: Apache-2.0
// A folder that goes away with its owner, and with everything in it.
#pragma once

#include <filesystem>
#include <utility>

namespace shoal::launch {

class ScratchFolder {
 public:
  // Made in `parent`; throws Error naming it when that fails.
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
};

}  // namespace shoal::launch
