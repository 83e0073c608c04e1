// SPDX-License-Identifier: Apache-2.0
// Parity with the original environments: replays a recorded trajectory's start, goal and actions in
// Shoal's physics and reports the deviations.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "actor/worlds/tools/parity_report.h"
#include "actor/worlds/tools/reference_file.h"

namespace shoal::worlds {

struct ReplayOptions {
  std::string model;    // path of another MJCF file; empty = the built-in model
  std::string physics;  // empty = the file's physics: mujoco2 for trajectories
};

// Replays a file. The tolerance is 1e-5 m. For two action sequences the tolerance is larger,
// because the arm folds onto itself and hulls of stand-in shapes touch: 1e-3 m for const_z_close
// and 1e-2 m for const_y. Positions, distances and dense rewards are judged; velocities, angles and
// joint coordinates are only reported.
//
// Slide's puck is judged until its first hit: the first step after which the puck's linear speed in
// the reference exceeds 0.01 m/s. (A puck at rest trembles at 0.001 to 0.002 m/s; a hit gives 0.1
// or more.) After the hit the puck's path is chaotic: input noise of 1e-8 grows to centimetres.
//
// Throws Error on a file that cannot be read or replayed; see ReadReference.
ReplayReport ReplayReference(const std::filesystem::path& path, const ReplayOptions& options = {});

// The first env step in which the puck is hit; 0 = none.
int FirstHit(const ReferenceTrajectory& reference);

}  // namespace shoal::worlds
