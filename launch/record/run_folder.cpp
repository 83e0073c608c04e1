#include "launch/record/run_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/checkpoint/checkpoint_files.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr int kMostNumbers = 10'000;

// False when it exists already. Throws Error when it cannot be made.
bool MakeNewFolder(const fs::path& path) {
  MakeFolders(path.parent_path());
  std::error_code error;
  const bool made = fs::create_directory(path, error);
  if (error) throw RuntimeError("cannot create folder '{}': {}", path.string(), error.message());
  return made;
}

void Remove(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path / "config.json") && !fs::is_empty(path, error)) {
    throw UsageError("'{}' is not a run (no config.json): not overwritten", path.string());
  }
  fs::remove_all(path, error);
  if (error) throw RuntimeError("cannot remove '{}': {}", path.string(), error.message());
}

struct flock WholeFile(short type) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  return lock;
}

}  // namespace

bool IsHeld(const fs::path& run) {
  const int file = open((run / ".lock").c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  struct flock lock = WholeFile(F_WRLCK);
  const bool held = fcntl(file, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
  close(file);
  return held;
}

RunFolder RunFolder::Create(const fs::path& dir, const std::string& name, bool overwrite) {
  const fs::path path = dir / name;
  if (!MakeNewFolder(path)) {
    if (!overwrite) {
      throw UsageError("run '{}' exists: choose another --run-name, --resume it or --overwrite it",
                       path.string());
    }
    { const RunFolder held(path); }  // refuses one that is running
    Remove(path);
    MakeNewFolder(path);
  }
  return RunFolder(path);
}

RunFolder RunFolder::CreateNumbered(const fs::path& dir, const std::string& base) {
  for (int number = 1; number <= kMostNumbers; ++number) {
    const fs::path path = dir / (number == 1 ? base : fmt::format("{}-{}", base, number));
    if (MakeNewFolder(path)) return RunFolder(path);
  }
  throw UsageError("'{}' holds {} runs called {}: choose a --run-name", dir.string(), kMostNumbers,
                   base);
}

RunFolder RunFolder::Reopen(const fs::path& dir, const std::string& run) {
  for (const fs::path& path : {fs::path(run), dir / run}) {
    if (fs::exists(path / "config.json")) return RunFolder(fs::weakly_canonical(path));
  }
  throw UsageError("no run '{}': neither '{}' nor '{}' has a config.json", run, run,
                   (dir / run).string());
}

RunFolder::RunFolder(fs::path path) : path_(std::move(path)) {
  const fs::path lock = path_ / ".lock";
  lock_ = open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock_ < 0) throw RuntimeError("cannot write '{}': {}", lock.string(), std::strerror(errno));
  // Locks of this kind can be asked for without being taken.
  struct flock whole = WholeFile(F_WRLCK);
  if (fcntl(lock_, F_OFD_SETLK, &whole) != 0) {
    close(std::exchange(lock_, -1));
    throw UsageError("run '{}' is running (its coordinator holds {})", path_.string(),
                     lock.string());
  }
  for (const char* folder : {"logs", "eval", "checkpoints", "made"}) MakeFolders(path_ / folder);
}

RunFolder::~RunFolder() {
  if (lock_ >= 0) close(lock_);
}

RunFolder::RunFolder(RunFolder&& other) noexcept
    : path_(std::move(other.path_)), lock_(std::exchange(other.lock_, -1)) {}

fs::path LogFile(const fs::path& run, const std::string& process) {
  return run / "logs" / (process + ".log");
}

fs::path NewestCheckpoint(const fs::path& run) {
  fs::path newest;
  std::optional<uint64_t> newest_updates;
  std::error_code error;
  for (fs::directory_iterator it(run / "checkpoints", error), end; !error && it != end;
       it.increment(error)) {
    const std::optional<uint64_t> updates = CheckpointUpdates(it->path().filename());
    if (updates > newest_updates) {
      newest_updates = updates;
      newest = it->path();
    }
  }
  return newest;
}

}  // namespace shoal::launch
