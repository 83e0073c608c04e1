// SPDX-License-Identifier: Apache-2.0
// Finds, creates, re-opens and locks the folder of a run. The lock excludes a second coordinator.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/base/file_lock.h"

namespace shoal::launch {

// A kind of folder that commands accept by name: its noun in messages, its parent folder, and the
// file that identifies a folder of this kind.
struct NamedKind {
  std::string noun{};  // "run"
  std::filesystem::path dir{};
  std::string file{};
};
NamedKind RunsIn(const std::filesystem::path& dir);

// Finds the folder of RUN or EXPERIMENT on a command line: the folder of this name in the `dir` of
// the first kind that has such a folder, else the path itself. Throws a usage error with all
// searched folders if there is no such folder, and a run-time error if a folder may not be read.
std::filesystem::path FindNamed(const std::string& name_or_folder,
                                std::span<const NamedKind> kinds);
inline std::filesystem::path FindNamed(const std::string& name_or_folder, const NamedKind& kind) {
  return FindNamed(name_or_folder, std::span(&kind, 1));
}

// Whether the folder holds a run, that is, has a config.json.
bool IsRun(const std::filesystem::path& folder);
// Whether this user may not read the folder, usually because it is another user's run.
bool IsForbidden(const std::filesystem::path& folder);

// Holds an exclusive lock on the run until destruction, or until this process and its forks without
// exec have ended.
class RunFolder {
 public:
  // Creates DIR/NAME. If the folder exists, throws a usage error. With `overwrite`, an existing
  // folder is deleted first, provided that it is empty, or is a run (has a config.json) that no
  // coordinator holds.
  static RunFolder Create(const std::filesystem::path& dir, const std::string& name,
                          bool overwrite);
  // Creates the first of DIR/BASE, DIR/BASE-2, DIR/BASE-3, ... that does not exist.
  static RunFolder CreateNumbered(const std::filesystem::path& dir, const std::string& base);
  // Opens an existing run so that the run continues. `run` is the run's name within `dir`, or its
  // path. Throws Error if the run does not exist or is running.
  static RunFolder Reopen(const std::filesystem::path& dir, const std::string& run);

  const std::filesystem::path& path() const { return path_; }
  std::string name() const { return path_.filename().string(); }

 private:
  explicit RunFolder(std::filesystem::path path);  // takes the lock and makes the subfolders

  std::filesystem::path path_;
  std::optional<FileLock> lock_;
};

// Whether a coordinator holds the lock of the run in this folder; does not take the lock. If the
// folder is on another host's disk, the file system must forward locks, as NFS does.
bool IsHeld(const std::filesystem::path& run);

// logs/PROCESS.log of a run.
std::filesystem::path LogFile(const std::filesystem::path& run, const std::string& process);
// The newest checkpoint in checkpoints/, by name; an empty path if there is no checkpoint.
std::filesystem::path NewestCheckpoint(const std::filesystem::path& run);
// The judged checkpoint of a run: the checkpoint of the best evaluation, or the newest checkpoint
// if there is no best; empty if there is no checkpoint.
std::filesystem::path JudgedCheckpoint(const std::filesystem::path& run);
// Files videos/*.mp4 of a run, sorted by name.
std::vector<std::filesystem::path> FilmsOf(const std::filesystem::path& run);

}  // namespace shoal::launch
