// SPDX-License-Identifier: Apache-2.0
// What a run is going to cost, as it is told when it starts.
#pragma once

#include <string>

#include "common/config/run_config.h"

namespace shoal::launch {

// Lines, each ended: pictures and what drawing them takes, what the replay takes or how long
// rollouts are, updates per env step, arithmetic, encoder and work of an update; what learning is
// told that the policy is not, and what the policy is told that its pictures show. Throws Error
// where the CPU lacks the asked precision.
std::string PlanText(const RunConfig& run, double frame_microseconds);

// One sentence where more actors than cores share this machine; else empty.
std::string SharedCoresText(int actors, int cores);

}  // namespace shoal::launch
