// SPDX-License-Identifier: Apache-2.0
#include "launch/record/kept_checkpoints.h"

#include <fcntl.h>
#include <stdio.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/checkpoint/checkpoint_files.h"
#include "common/run_folder/run_file_names.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

// Exchanges two folders, or moves `from` to `to` if `to` does not exist.
void Swap(const fs::path& from, const fs::path& to) {
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) == 0) return;
  if (errno == ENOENT && rename(from.c_str(), to.c_str()) == 0) return;
  throw RuntimeError("cannot rename '{}' to '{}': {}", from.string(), to.string(),
                     std::strerror(errno));
}

// Throws Error when it cannot be read.
std::vector<std::string> NamesIn(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    names.push_back(it->path().filename());
  }
  if (error) throw RuntimeError("cannot read '{}': {}", folder.string(), error.message());
  return names;
}

// Replaces folder `to` by a copy of checkpoint `from`. The copy is made under a temporary name.
void Keep(const fs::path& from, const fs::path& to) {
  const fs::path fresh = to.parent_path() / fmt::format(".{}.tmp", to.filename().string());
  std::error_code error;
  fs::remove_all(fresh, error);
  if (!fs::is_directory(from)) {
    throw RuntimeError("checkpoint '{}' is gone: it cannot be kept", from.string());
  }
  ReadCheckpointFiles(from);  // throws if incomplete
  MakeFolders(fresh);
  for (const std::string& name : NamesIn(from)) {
    // The files of a checkpoint never change, so two folders may share them.
    fs::create_hard_link(from / name, fresh / name, error);
    if (error) WriteFileAtomically(fresh / name, ReadFile(from / name));
  }
  ReadCheckpointFiles(fresh);  // throws if the learner pruned `from` during the copy
  SyncFolder(fresh);
  Swap(fresh, to);
  SyncFolder(to.parent_path());
  fs::remove_all(fresh, error);  // the previous contents of `to`
}

// Whether both folders share their files. Equal names do not suffice: a learner that continued from
// an earlier checkpoint can write a different one under the same name.
bool ShareFiles(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return fs::equivalent(a / kPolicyFile, b / kPolicyFile, error);
}

void RemoveOthers(const fs::path& folder, const std::vector<std::string>& names) {
  std::error_code error;
  for (const std::string& name : NamesIn(folder)) {
    if (std::ranges::find(names, name) == names.end()) fs::remove_all(folder / name, error);
  }
}

}  // namespace

void KeepCheckpoints(const fs::path& run, const std::vector<std::string>& candidates,
                     const std::string& best) {
  const fs::path checkpoints = run / kCheckpointFolder, kept = checkpoints / kCandidateFolder;
  std::error_code error;
  fs::create_directory(kept, error);  // without its parents: the run's folder may have been moved
  if (error) throw RuntimeError("cannot create '{}': {}", kept.string(), error.message());
  // The best checkpoint is kept first, so that a failure with another one does not prevent it.
  std::vector<std::string> names{best};
  std::ranges::copy_if(candidates, std::back_inserter(names),
                       [&](const std::string& name) { return name != best; });
  for (const std::string& name : names) {
    const bool pruned = fs::is_directory(kept / name) && !fs::is_directory(checkpoints / name);
    if (!pruned && !ShareFiles(checkpoints / name, kept / name)) {
      Keep(checkpoints / name, kept / name);
    }
    if (name == best && !ShareFiles(kept / best, checkpoints / kBestCheckpoint)) {
      Keep(kept / best, checkpoints / kBestCheckpoint);
    }
  }
  RemoveOthers(kept, names);
}

}  // namespace shoal::launch
