// SPDX-License-Identifier: Apache-2.0
#include "launch/film/film_checkpoints.h"

#include <algorithm>
#include <map>

#include "common/base/error.h"
#include "common/checkpoint/checkpoint_files.h"
#include "common/run_folder/run_file_names.h"
#include "launch/record/run_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr size_t kEarlier = 3;  // shown before the last

std::map<uint64_t, fs::path> CheckpointsByUpdates(const fs::path& run) {
  std::map<uint64_t, fs::path> found;
  std::error_code error;
  for (fs::directory_iterator it(run / kCheckpointFolder, error), end; !error && it != end;
       it.increment(error)) {
    if (const auto updates = CheckpointUpdates(it->path().filename())) {
      found.emplace(*updates, it->path());
    }
  }
  return found;
}

}  // namespace

fs::path FilmedCheckpoint(const fs::path& run, const std::string& name) {
  if (!name.empty()) {
    const fs::path named = run / kCheckpointFolder / name;
    const bool one_name = fs::path(name).filename() == name && name != "." && name != "..";
    if (one_name && fs::is_directory(named)) return named;
    throw UsageError("run '{}' has no checkpoint '{}' (best, or a name in {})", run.string(), name,
                     (run / kCheckpointFolder).string());
  }
  const fs::path checkpoint = JudgedCheckpoint(run);
  if (checkpoint.empty()) throw RuntimeError("run '{}' has no checkpoint yet", run.string());
  return checkpoint;
}

std::vector<fs::path> CheckpointsAcross(const fs::path& run) {
  const fs::path last = FilmedCheckpoint(run, "");
  const uint64_t updates = ReadCheckpointFiles(last).state.updates;
  std::vector<fs::path> earlier;
  for (const auto& [at, path] : CheckpointsByUpdates(run)) {
    if (at < updates) earlier.push_back(path);
  }
  // Evenly spread from the first on; the last of the film is not among them.
  std::vector<fs::path> shown;
  const size_t count = std::min(kEarlier, earlier.size());
  for (size_t i = 0; i < count; ++i) shown.push_back(earlier[i * earlier.size() / count]);
  shown.push_back(last);
  return shown;
}

}  // namespace shoal::launch
