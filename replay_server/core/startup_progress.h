// SPDX-License-Identifier: Apache-2.0
// Callback that reports progress during a long start. Reading a ring of many gigabytes takes
// minutes if the file is not in the page cache.
#pragma once

#include <functional>

namespace shoal::replay {

// Called often, about once for each record, so the function must be fast. Empty = no progress is
// reported.
using StartupProgress = std::function<void()>;

}  // namespace shoal::replay
