// SPDX-License-Identifier: Apache-2.0
// A run's folder: named, created or re-opened, and held against a second coordinator.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/base/file_lock.h"

namespace shoal::launch {

// Folders that commands take by name: what they are called in messages, where they lie, and the
// file that tells one of them from any other folder.
struct NamedKind {
  std::string noun{};  // "run"
  std::filesystem::path dir{};
  std::string file{};
};
NamedKind RunsIn(const std::filesystem::path& dir);

// Which folder RUN or EXPERIMENT on a command line means: the one of that name within a kind's
// `dir`, by the order of the kinds, else the path itself. Throws Error: usage naming every folder
// that was looked at; run-time where one of them may not be read.
std::filesystem::path FindNamed(const std::string& name_or_folder,
                                std::span<const NamedKind> kinds);
inline std::filesystem::path FindNamed(const std::string& name_or_folder, const NamedKind& kind) {
  return FindNamed(name_or_folder, std::span(&kind, 1));
}

// Whether the folder holds a run: one whose configuration has been written.
bool IsRun(const std::filesystem::path& folder);
// Whether the folder may not be looked into: another user's run, as a rule.
bool IsForbidden(const std::filesystem::path& folder);

// Holds an exclusive lock on the run until destruction (or death of the process and of those it
// forked without exec).
class RunFolder {
 public:
  // Creates DIR/NAME. A given name whose folder exists is refused (usage error) unless `overwrite`,
  // which deletes it first, if it is empty or a run (has a config.json) that no coordinator holds.
  static RunFolder Create(const std::filesystem::path& dir, const std::string& name,
                          bool overwrite);
  // Creates DIR/BASE, or DIR/BASE-2, DIR/BASE-3, ...: the first that does not exist.
  static RunFolder CreateNumbered(const std::filesystem::path& dir, const std::string& base);
  // Opens an existing run for going on. `run` is its name within `dir`, or its path. Throws Error
  // when there is none or when it is running.
  static RunFolder Reopen(const std::filesystem::path& dir, const std::string& run);

  const std::filesystem::path& path() const { return path_; }
  std::string name() const { return path_.filename().string(); }

 private:
  explicit RunFolder(std::filesystem::path path);  // takes the lock, makes the subfolders

  std::filesystem::path path_;
  std::optional<FileLock> lock_;
};

// Whether a coordinator holds the run in this folder: asks, without holding it. On another host's
// disk this works where the file system passes locks on (NFS does).
bool IsHeld(const std::filesystem::path& run);

// logs/PROCESS.log of a run.
std::filesystem::path LogFile(const std::filesystem::path& run, const std::string& process);
// The newest of checkpoints/ by its name; empty path when there is none.
std::filesystem::path NewestCheckpoint(const std::filesystem::path& run);
// The checkpoint a run is judged by: the best evaluated one, else the newest; empty without any.
std::filesystem::path JudgedCheckpoint(const std::filesystem::path& run);
// videos/*.mp4 of a run, by name.
std::vector<std::filesystem::path> FilmsOf(const std::filesystem::path& run);

}  // namespace shoal::launch
