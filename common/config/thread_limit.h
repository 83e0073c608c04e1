// SPDX-License-Identifier: Apache-2.0
// Keys that ask for threads, against the cores of their host.
#pragma once

#include <string_view>

#include "common/base/usable_cores.h"

namespace shoal {

// Throws Error (kUsage) unless the `threads` that the key asks for have a core each: threads of one
// update, or of one batch, wait for each other, so that more of them than cores are slower than one
// per core. The error says what limits the cores. `limits` are those of the threads' host.
void CheckCores(std::string_view key, int threads, const CoreLimits& limits);

}  // namespace shoal
