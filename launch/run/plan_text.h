// SPDX-License-Identifier: Apache-2.0
// The cost of a run, as printed when it starts.
#pragma once

#include <string>

#include "common/config/run_config.h"

namespace shoal::launch {

// Lines, each with its newline: pictures and the cost of drawing them; memory of the replay or
// length of rollouts; updates per env step; arithmetic, encoder and work of an update; privileged
// inputs of learning; the object's position as an input of the policy. Throws Error if the CPU
// lacks the requested precision.
std::string PlanText(const RunConfig& run, double frame_microseconds);

// One sentence if more actors than cores share this machine; else empty.
std::string SharedCoresText(int actors, int cores);

}  // namespace shoal::launch
