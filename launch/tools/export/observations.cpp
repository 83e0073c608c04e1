// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/export/observations.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include "common/base/error.h"
#include "common/base/random.h"
#include "common/config/run_files.h"
#include "common/run_folder/run_file_names.h"
#include "launch/record/run_folder.h"
#include "replay_server/core/peek.h"
#include "replay_server/core/replay_core.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr double kFarShare = 0.1, kFarFactor = 30;

// Returns the run that contains the checkpoint; empty if there is none.
fs::path RunOf(const fs::path& checkpoint) {
  const fs::path checkpoints = fs::weakly_canonical(checkpoint).parent_path();
  for (const fs::path& folder :
       {checkpoints.parent_path(), checkpoints.parent_path().parent_path()}) {
    if (IsRun(folder)) return folder;
  }
  return {};
}

}  // namespace

ObservationSet RandomObservations(const ObservationSpec& spec,
                                  const std::optional<nn::VectorScale>& scale, int count,
                                  uint64_t seed) {
  Random random(HashWords({seed, uint64_t(count)}));
  ObservationSet result{.count = count};
  for (int n = 0; n < count && spec.HasPixels(); ++n) {
    const uint64_t low = random.Below(256), levels = random.Below(256 - low) + 1;
    const int bytes = spec.InputBytes();
    std::generate_n(std::back_inserter(result.frames), bytes,
                    [&] { return uint8_t(low + random.Below(levels)); });
  }
  const auto columns = size_t(spec.VectorSize());
  for (size_t i = 0; i < size_t(count) * columns; ++i) {
    const double far = scale && random.Uniform() < kFarShare ? kFarFactor : 1;
    const double z = random.Normal() * far;
    const size_t j = i % columns;
    result.vectors.push_back(scale ? scale->mean()[j] + float(z) / scale->factor()[j] : float(z));
  }
  return result;
}

std::optional<ObservationSet> RecordedObservations(const fs::path& checkpoint,
                                                   const ObservationSpec& spec, int count,
                                                   uint64_t seed, std::string* why) {
  const fs::path run = RunOf(checkpoint);
  if (run.empty()) {
    *why = "the checkpoint is in no run";
    return std::nullopt;
  }
  if (!fs::exists(run / kRingFile)) {
    *why = replay::DescribeMissingRing(run / kRingFile);
    return std::nullopt;
  }
  try {
    if (ReadRunConfig(run).spec.Hash() != spec.Hash()) {
      *why = fmt::format("the run in '{}' observes something else", run.string());
      return std::nullopt;
    }
    replay::PeekedObservations peeked = replay::PeekObservations(run, count, seed);
    return ObservationSet{count, std::move(peeked.frames), std::move(peeked.vectors)};
  } catch (const Error& error) {
    *why = error.what();
    return std::nullopt;
  }
}

std::map<std::string, std::vector<float>> BlocksOf(const ObservationSpec& spec,
                                                   const ObservationSet& observations) {
  std::map<std::string, std::vector<float>> blocks;
  const auto row = spec.VectorSize();
  for (const BlockSpec& block : spec.blocks) {
    const auto range = spec.Observed(block.name);
    if (!range) continue;
    std::vector<float>& values = blocks[block.name];
    for (int n = 0; n < observations.count; ++n) {
      const auto begin = observations.vectors.begin() + std::ptrdiff_t(n) * row + range->first;
      values.insert(values.end(), begin, begin + range->size);
    }
  }
  return blocks;
}

}  // namespace shoal::launch
