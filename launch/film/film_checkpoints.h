// SPDX-License-Identifier: Apache-2.0
// Which checkpoints of a run a film shows.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shoal::launch {

// checkpoints/NAME of the run; with an empty name the best, else the newest. Throws Error: usage
// where there is none of that name, run-time where the run has none at all yet.
std::filesystem::path FilmedCheckpoint(const std::filesystem::path& run, const std::string& name);

// At most four in the order in which they were trained: the first, two between, and the best, else
// the newest. Throws as FilmedCheckpoint, and for files of the best that cannot be read.
std::vector<std::filesystem::path> CheckpointsAcross(const std::filesystem::path& run);

}  // namespace shoal::launch
