// SPDX-License-Identifier: Apache-2.0
// The cost of a run, as printed when it starts.
#pragma once

#include <string>

#include "common/config/run_config.h"

namespace shoal::launch {

// Lines, each ending with a newline: pictures and the cost of drawing; memory of the replay or
// length of rollouts; updates per env step; precision, encoder and operations of an update;
// privileged inputs of learning; a note if the policy gets the object's position. Throws Error if
// the CPU lacks the requested precision.
std::string PlanText(const RunConfig& run, double frame_microseconds);

// One sentence if more actors than cores share this machine; else empty.
std::string SharedCoresText(int actors, int cores);

}  // namespace shoal::launch
