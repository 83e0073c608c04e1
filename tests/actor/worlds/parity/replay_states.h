// SPDX-License-Identifier: Apache-2.0
// Parity of the environments without goals: writes a recorded trajectory's initial state, replays
// its actions and compares the state, the observation, the reward and whether the episode
// terminates.
#pragma once

#include <filesystem>

#include "actor/worlds/tools/parity_report.h"
#include "actor/worlds/tools/replay_reference.h"

namespace shoal::worlds {

// Hopper: the tolerance of every number is 1e-9. It is 1e-4 in `zero`, whose symmetric landing
// amplifies the last digits; velocities and numbers derived from them are then only reported. The
// recorded velocities are clipped in every variant, so Shoal's are compared after clipping.
//
// Control Suite: see kControlTolerance in the source. Throws Error on a file that cannot be read or
// replayed; see ReadStateReference.
ReplayReport ReplayStates(const std::filesystem::path& path, const ReplayOptions& options = {});

}  // namespace shoal::worlds
