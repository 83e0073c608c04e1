// SPDX-License-Identifier: Apache-2.0
// Exports episodes from a run's replay ring as a Minari dataset.
#pragma once

#include <cstdint>
#include <filesystem>

#include "common/config/run_config.h"

namespace shoal::launch {

struct EpisodeExport {
  RunConfig run;
  std::filesystem::path ring;    // replay.ring of the run
  std::filesystem::path output;  // the HDF5 file; metadata.json is written beside it
  uint64_t episodes = 0;         // largest number of episodes; 0: all
  bool last = false;             // exports the newest episodes, not the oldest
};

struct ExportedEpisodes {
  uint64_t episodes = 0, steps = 0;
  uint64_t bytes = 0;                     // of the HDF5 file
  uint64_t overwritten = 0, unended = 0;  // left out: beginning or end not stored
};

// Exports whole episodes only, in the order in which they ended. A server may be writing to the
// ring. Throws Error if the ring is missing, damaged, of another spec or without a whole episode,
// if metadata.json belongs to something else, or if the disk is full. Otherwise both files exist.
ExportedEpisodes ExportEpisodes(const EpisodeExport& asked);

}  // namespace shoal::launch
