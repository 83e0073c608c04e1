// SPDX-License-Identifier: Apache-2.0
// Checks keys that set a number of threads against the cores of the host.
#pragma once

#include <string_view>

#include "common/base/usable_cores.h"

namespace shoal {

// Throws Error (kUsage) if the key sets more `threads` than there are usable cores. Threads of one
// update or one batch wait for each other, so more threads than cores are slower than one per core.
// The error names the limit on the cores. `limits` must describe the threads' host.
void CheckCores(std::string_view key, int threads, const CoreLimits& limits);

}  // namespace shoal
