// SPDX-License-Identifier: Apache-2.0
// Episodes out of a run's replay ring as a dataset of Minari's.
#pragma once

#include <cstdint>
#include <filesystem>

#include "common/config/run_config.h"

namespace shoal::launch {

struct EpisodeExport {
  RunConfig run;
  std::filesystem::path ring;    // its replay.ring
  std::filesystem::path output;  // the HDF5 file; metadata.json is written beside it
  uint64_t episodes = 0;         // at most so many; 0: all
  bool last = false;             // those that ended last, not first
};

struct ExportedEpisodes {
  uint64_t episodes = 0, steps = 0;
  uint64_t bytes = 0;                     // of the HDF5 file
  uint64_t overwritten = 0, unended = 0;  // left out: the beginning or the end is not stored
};

// Exports whole episodes only, in the order in which they ended. A server may be writing to the
// ring. Throws Error if the ring is missing, damaged, of another spec or without a whole episode,
// if metadata.json belongs to something else, or if the disk is full. Otherwise both files exist.
ExportedEpisodes ExportEpisodes(const EpisodeExport& asked);

}  // namespace shoal::launch
