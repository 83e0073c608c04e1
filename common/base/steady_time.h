// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace shoal {

// A point on the clock of deadlines.
using SteadyTime = std::chrono::steady_clock::time_point;

}  // namespace shoal
