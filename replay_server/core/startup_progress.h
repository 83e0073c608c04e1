// SPDX-License-Identifier: Apache-2.0
// Callback that reports progress during a long start: reading a cold ring of many gigabytes takes
// minutes.
#pragma once

#include <functional>

namespace shoal::replay {

// Called often, about once per record; must be cheap. Empty = no progress is reported.
using StartupProgress = std::function<void()>;

}  // namespace shoal::replay
