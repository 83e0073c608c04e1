// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/dataset/export_episodes.h"

#include <algorithm>
#include <cstddef>

#include "common/base/error.h"
#include "common/base/files.h"
#include "launch/tools/dataset/episode_arrays.h"
#include "launch/tools/dataset/hdf5_file.h"
#include "launch/tools/dataset/minari_metadata.h"
#include "replay_server/core/stored_episodes.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

// A dataset is replaced as a whole, but a metadata.json without a dataset is refused.
void CheckOutput(const fs::path& output, const fs::path& metadata) {
  CheckWritable(output);
  std::error_code error;
  if (fs::exists(metadata, error) && !fs::exists(output, error)) {
    throw UsageError("'{}' belongs to something else: give the dataset a folder of its own",
                     metadata.string());
  }
}

// Returns the requested ones of the whole episodes.
std::vector<std::vector<uint64_t>> Chosen(const EpisodeExport& asked,
                                          std::vector<std::vector<uint64_t>> whole) {
  if (asked.episodes == 0 || asked.episodes >= whole.size()) return whole;
  const auto count = static_cast<std::ptrdiff_t>(asked.episodes);
  if (asked.last) whole.erase(whole.begin(), whole.end() - count);
  whole.resize(asked.episodes);
  return whole;
}

}  // namespace

ExportedEpisodes ExportEpisodes(const EpisodeExport& asked) {
  const ObservationSpec& spec = asked.run.spec;
  const fs::path metadata = asked.output.parent_path() / kMinariMetadata;
  CheckArrayNames(spec);
  CheckOutput(asked.output, metadata);
  const replay::Ring ring = replay::Ring::OpenSnapshot(spec, asked.ring);
  const replay::StoredEpisodes stored = replay::FindEpisodes(ring);
  ExportedEpisodes result{.overwritten = stored.overwritten, .unended = stored.unended};

  Hdf5File file(asked.output);
  for (const std::vector<uint64_t>& ids : Chosen(asked, stored.whole)) {
    const auto records = replay::CopyEpisode(ring, ids);
    if (!records) {
      ++result.overwritten;
      continue;
    }
    WriteEpisode(spec, *records, result.episodes++, &file);
    result.steps += ids.size() - 1;
  }
  if (result.episodes == 0) {
    throw RuntimeError(
        "replay file '{}' holds no whole episode: {} without their beginning, {} without their end",
        asked.ring.string(), result.overwritten, result.unended);
  }
  file.Finish();
  result.bytes = fs::file_size(asked.output);
  WriteFileForOthers(metadata,
                     MinariMetadata(spec, {.run = asked.run.config.run_name,
                                           .algorithm = asked.run.config.learner.algorithm,
                                           .episodes = result.episodes,
                                           .steps = result.steps,
                                           .bytes = result.bytes}));
  return result;
}

}  // namespace shoal::launch
