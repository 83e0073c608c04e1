// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/film/film_checkpoints.h"

#include <algorithm>
#include <map>

#include "common/checkpoint/checkpoint_files.h"
#include "common/run_folder/run_file_names.h"
#include "launch/record/named_checkpoint.h"

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

std::vector<fs::path> CheckpointsAcross(const fs::path& run) {
  const fs::path last = FindCheckpoint({.run = run.string()}).checkpoint;
  const uint64_t updates = ReadCheckpointFiles(last).state.updates;
  std::vector<fs::path> earlier;
  for (const auto& [at, path] : CheckpointsByUpdates(run)) {
    if (at < updates) earlier.push_back(path);
  }
  // Earlier checkpoints, evenly spread from the first on; the last checkpoint follows them.
  std::vector<fs::path> shown;
  const size_t count = std::min(kEarlier, earlier.size());
  for (size_t i = 0; i < count; ++i) shown.push_back(earlier[i * earlier.size() / count]);
  shown.push_back(last);
  return shown;
}

}  // namespace shoal::launch
