// SPDX-License-Identifier: Apache-2.0
// Replays a file of measurements of either format.
#pragma once

#include <filesystem>
#include <vector>

#include "actor/worlds/tools/replay_reference.h"

namespace shoal::worlds {

// A trajectory (vrl-ref-1) gives one report, see ReplayReference and, for environments without
// goals, ReplayStates; a file of grip positions in newer
// versions of MuJoCo (vrl-xversion-1) one for each of MuJoCo 3.3.8's sequences whose actions are
// known (the others are logged), see CrossVersionTolerance. These are replayed with physics
// mujoco3 unless the options say otherwise, and in our own models only.
//
// A file of pictures (vrl-frames-1), which lies beside them, is logged and gives no report.
//
// Throws Error on a file that cannot be read or replayed and on physics or a model that do not
// exist.
std::vector<ReplayReport> ReplayFile(const std::filesystem::path& path,
                                     const ReplayOptions& options = {});

// How far the grip may be from MuJoCo 3.3.8's, m: 1e-3; 1.5e-2 for const_y, where the arm folds
// onto itself; 3e-3 for zero in the tasks that start above the table, where the gripper sinks
// slowly under its own weight and the two versions do so at another rate.
double CrossVersionTolerance(const std::string& task, const std::string& sequence);

}  // namespace shoal::worlds
