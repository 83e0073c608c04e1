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
  std::filesystem::path output;  // the HDF5 file; metadata.json is written to the same folder
  uint64_t episodes = 0;         // largest number of episodes; 0: all
  bool last = false;             // true: exports the newest episodes, not the oldest
};

struct ExportedEpisodes {
  uint64_t episodes = 0, steps = 0;
  uint64_t bytes = 0;                     // size of the HDF5 file
  uint64_t overwritten = 0, unended = 0;  // episodes left out: beginning or end is not stored
};

// Exports whole episodes only, in the order in which they ended. A server may be writing to the
// ring. Throws Error if the ring is missing, damaged, of another spec or without a whole episode,
// if there is a metadata.json without its HDF5 file, or if the disk is full. Without an error, both
// files exist afterwards.
ExportedEpisodes ExportEpisodes(const EpisodeExport& asked);

}  // namespace shoal::launch
