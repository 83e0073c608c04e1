// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/scratch_folder.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "common/base/error.h"
#include "common/base/files.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr char kPrefix[] = "shoal-", kOwner[] = ".owner";

bool IsOwnFolder(const fs::path& path) {
  struct stat status;
  return lstat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode) && status.st_uid == geteuid();
}

// Removes scratch folders in `parent` whose owner process has ended. Keeps folders without a lock
// file (they are being created, or belong to another program) and folders that cannot be removed.
void RemoveAbandoned(const fs::path& parent) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(parent, error)) {
    const fs::path owner = entry.path() / kOwner;
    if (!entry.path().filename().string().starts_with(kPrefix) || !IsOwnFolder(entry.path()) ||
        !fs::is_regular_file(fs::symlink_status(owner, error)) || IsLocked(owner)) {
      continue;
    }
    fs::remove_all(entry.path(), error);
  }
}

}  // namespace

ScratchFolder::ScratchFolder(const fs::path& parent) {
  RemoveAbandoned(parent);
  path_ = MakeFreshFolder(kPrefix, parent);
  // The lock file is renamed only after it is locked: an unlocked one marks an abandoned folder.
  const fs::path unnamed = path_ / ".owner.new";
  owner_ = FileLock::Take(unnamed);
  fs::rename(unnamed, path_ / kOwner);
}

ScratchFolder ScratchFolder::WithinRun(const fs::path& run) {
  const fs::path path = run / fmt::format(".scratch.tmp-{}", getpid());
  std::error_code error;
  fs::remove_all(path, error);  // left by a dead process with the same pid
  if (mkdir(path.c_str(), 0700) != 0) {
    throw RuntimeError("cannot create folder '{}': {}", path.string(), std::strerror(errno));
  }
  return {path, Made{}};
}

ScratchFolder::~ScratchFolder() {
  std::error_code error;
  fs::remove_all(path_, error);
}

}  // namespace shoal::launch
