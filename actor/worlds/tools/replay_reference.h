// SPDX-License-Identifier: Apache-2.0
// Parity with the original environments: replays a recorded trajectory's start, goal and actions in
// our physics and says how far apart the two get.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "actor/worlds/tools/parity_report.h"
#include "actor/worlds/tools/reference_file.h"

namespace shoal::worlds {

struct ReplayOptions {
  std::string model;    // path of another MJCF file; empty = our own
  std::string physics;  // empty = that of the file: mujoco2 for trajectories
};

// Tolerances: 1e-5 m; 1e-3 m for const_z_close and 1e-2 m for const_y, where the arm folds onto
// itself and hulls of stand-in shapes meet. Positions, distances and dense rewards are judged,
// velocities, angles and joint coordinates reported.
//
// Slide's puck is judged until it is hit: until the first step after which its linear speed in the
// reference exceeds 0.01 m/s. (At rest it trembles at 0.001 to 0.002 m/s, a hit gives it 0.1 or
// more.) From there on the puck's path is chaotic: input noise of 1e-8 grows to centimetres.
//
// Throws Error on a file that cannot be read or replayed; see ReadReference.
ReplayReport ReplayReference(const std::filesystem::path& path, const ReplayOptions& options = {});

// The first env step that counts as hit, 0 = none.
int FirstHit(const ReferenceTrajectory& reference);

}  // namespace shoal::worlds
