// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace shoal {

// A point in time of the steady clock, which deadlines use.
using SteadyTime = std::chrono::steady_clock::time_point;

}  // namespace shoal
