// SPDX-License-Identifier: Apache-2.0
// Choice of the checkpoints of a run for a film.
#pragma once

#include <filesystem>
#include <vector>

namespace shoal::launch {

// At most four checkpoints, in the order of training: the first, two checkpoints between, and the
// best (if there is no best, the newest). Throws Error if the run has no checkpoint yet, or if the
// files of the best checkpoint cannot be read.
std::vector<std::filesystem::path> CheckpointsAcross(const std::filesystem::path& run);

}  // namespace shoal::launch
