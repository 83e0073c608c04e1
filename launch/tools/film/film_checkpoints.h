// SPDX-License-Identifier: Apache-2.0
// Which checkpoints of a run a film shows.
#pragma once

#include <filesystem>
#include <vector>

namespace shoal::launch {

// At most four in the order in which they were trained: the first, two between, and the best, else
// the newest. Throws Error where the run has none yet, and for files of the best that cannot be
// read.
std::vector<std::filesystem::path> CheckpointsAcross(const std::filesystem::path& run);

}  // namespace shoal::launch
