// SPDX-License-Identifier: Apache-2.0
// Checkpoints that a run keeps after the learner has deleted its older checkpoints: the checkpoint
// of the best evaluation, and the checkpoints of evaluations that may become the best.
//
//   RUN/checkpoints/best                   checkpoint of the best evaluation
//   RUN/checkpoints/candidates/step_N      each checkpoint that is kept
//
// Files are hard links if the file system supports them, so a candidate needs no extra space.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shoal::launch {

// Makes checkpoints/best the checkpoint `best`, which is one of the candidates, and makes
// checkpoints/candidates hold exactly `candidates`. Candidates that are new or rewritten are taken
// from checkpoints/NAME. A reader finds a complete checkpoints/best at any time, the old or the new
// checkpoint. Throws Error if a checkpoint is missing, truncated or altered, or the disk is full.
// The old checkpoints/best then remains, unless only another candidate could not be kept.
void KeepCheckpoints(const std::filesystem::path& run, const std::vector<std::string>& candidates,
                     const std::string& best);

}  // namespace shoal::launch
