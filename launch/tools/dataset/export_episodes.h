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
  uint64_t overwritten = 0, unended = 0;  // left out: their beginning, their end is not there
};

// Whole episodes alone, in the order in which they ended; a server may be writing to the ring. Both
// files are there, or an Error is thrown: a ring that is missing, damaged or of another spec,
// without a whole episode; a metadata.json that belongs to something else; no room.
ExportedEpisodes ExportEpisodes(const EpisodeExport& asked);

}  // namespace shoal::launch
