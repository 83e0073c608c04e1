// SPDX-License-Identifier: Apache-2.0
// Checkpoints that outlive the learner's own pruning: that of the best evaluation, and of those
// that later ones may make the best.
//
//   RUN/checkpoints/best                   the best one
//   RUN/checkpoints/candidates/step_N      each of them
//
// Files are linked where the file system can, so that a candidate takes no room of its own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shoal::launch {

// Makes checkpoints/best that of `best`, one of the candidates, and checkpoints/candidates exactly
// these, each from checkpoints/NAME where it is not a candidate yet; a reader finds the old best or
// the new one, whole. Throws Error when one is gone, cut short or altered, or the disk is full; the
// old best is then still there, unless it was another candidate that could not be kept.
void KeepCheckpoints(const std::filesystem::path& run, const std::vector<std::string>& candidates,
                     const std::string& best);

}  // namespace shoal::launch
