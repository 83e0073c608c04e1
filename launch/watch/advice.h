// SPDX-License-Identifier: Apache-2.0
// One sentence: what to do about where a run's time goes. Pure.
#pragma once

#include <string>

#include "launch/watch/bottleneck.h"

namespace shoal::launch {

// Names what would make the run faster, and nothing that cannot be had: no more actors than the
// host has cores, no fewer than one. What the run was asked for, as its updates per env step, is
// named as a choice.
std::string Advise(const Bottleneck& figures, const RunResources& resources);

}  // namespace shoal::launch
