// A run's folder: named, created or re-opened, and held against a second coordinator.
#pragma once

#include <filesystem>
#include <string>

namespace shoal::launch {

// Holds an exclusive lock on the run until destruction (or death of the process and of those it
// forked without exec).
class RunFolder {
 public:
  // Creates DIR/NAME. A given name whose folder exists is refused (usage error) unless `overwrite`,
  // which deletes it first, if it is a run (has a config.json) or empty, and nobody runs it.
  static RunFolder Create(const std::filesystem::path& dir, const std::string& name,
                          bool overwrite);
  // Creates DIR/BASE, or DIR/BASE-2, DIR/BASE-3, ...: the first that does not exist.
  static RunFolder CreateNumbered(const std::filesystem::path& dir, const std::string& base);
  // Opens an existing run for going on. `run` is its path, or its name within `dir`. Throws Error
  // when there is none or when it is running.
  static RunFolder Reopen(const std::filesystem::path& dir, const std::string& run);

  ~RunFolder();
  RunFolder(RunFolder&& other) noexcept;
  RunFolder& operator=(RunFolder&&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::string name() const { return path_.filename().string(); }

 private:
  explicit RunFolder(std::filesystem::path path);  // takes the lock, makes the subfolders

  std::filesystem::path path_;
  int lock_ = -1;
};

// Whether a coordinator holds the run in this folder: asks, without holding it. On another host's
// disk this works where the file system passes locks on (NFS does).
bool IsHeld(const std::filesystem::path& run);

// logs/PROCESS.log of a run.
std::filesystem::path LogFile(const std::filesystem::path& run, const std::string& process);
// The newest of checkpoints/ by its name; empty path when there is none.
std::filesystem::path NewestCheckpoint(const std::filesystem::path& run);

}  // namespace shoal::launch
