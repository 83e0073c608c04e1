// SPDX-License-Identifier: Apache-2.0
// Parity of the environments without goals. Sets the initial state of a recorded trajectory,
// replays its actions and compares the state, the observation, the reward and whether the episode
// terminates.
#pragma once

#include <filesystem>

#include "actor/worlds/tools/parity_report.h"
#include "actor/worlds/tools/replay_reference.h"

namespace shoal::worlds {

// Hopper: the tolerance of every number is 1e-9. In the sequence `zero` the tolerance is 1e-4,
// because the symmetric landing amplifies the last digits; velocities and numbers derived from
// velocities are then only reported. The recorded velocities are clipped in every variant, so
// Shoal's velocities are clipped before the comparison.
//
// Control Suite: see kControlTolerance in the source. Throws Error on a file that cannot be read or
// replayed; see ReadStateReference.
ReplayReport ReplayStates(const std::filesystem::path& path, const ReplayOptions& options = {});

}  // namespace shoal::worlds
