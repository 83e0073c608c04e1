// SPDX-License-Identifier: Apache-2.0
// Reads the configuration of a run that has a replay.
#pragma once

#include <filesystem>

#include "common/config/run_config.h"

namespace shoal::launch {

// Throws Error (usage) if the run's algorithm learns from rollouts, and the errors of
// ReadRunConfig.
RunConfig ReadRunWithReplay(const std::filesystem::path& run);

}  // namespace shoal::launch
