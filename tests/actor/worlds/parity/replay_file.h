// SPDX-License-Identifier: Apache-2.0
// Replays a file of measurements.
#pragma once

#include <filesystem>
#include <vector>

#include "actor/worlds/tools/replay_reference.h"

namespace shoal::worlds {

// A trajectory (vrl-ref-1) gives one report: see ReplayReference and, for environments without
// goals, ReplayStates.
//
// A file of grip positions in newer versions of MuJoCo (vrl-xversion-1) gives one report for each
// sequence of MuJoCo 3.3.8 whose actions are known; other sequences are logged. See
// CrossVersionTolerance. These sequences are replayed only in Shoal's own models, with physics
// mujoco3 unless the options name other physics.
//
// A file of pictures (vrl-frames-1) from the same folder is logged and gives no report.
//
// Throws Error if the file cannot be read or replayed, or if the physics or the model does not
// exist.
std::vector<ReplayReport> ReplayFile(const std::filesystem::path& path,
                                     const ReplayOptions& options = {});

// Largest allowed distance of the grip from the grip in MuJoCo 3.3.8, in m: 1e-3. Two sequences
// have other values. const_y: 1.5e-2, because the arm folds onto itself. zero, in tasks that start
// above the table: 3e-3, because the gripper sinks under its own weight at a different rate in the
// two versions.
double CrossVersionTolerance(const std::string& task, const std::string& sequence);

}  // namespace shoal::worlds
