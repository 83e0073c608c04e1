// SPDX-License-Identifier: Apache-2.0
// The first lines of a run: its parts, its cost, and how to watch the run.
#pragma once

#include <filesystem>
#include <string>

#include "common/config/run_files.h"
#include "launch/run/run_request.h"

namespace shoal::launch {

// Each line ends with a newline. `address` is already reserved. Throws Error if the CPU lacks the
// requested precision.
std::string StartText(const RunRequest& request, const std::filesystem::path& run,
                      const ClusterAddress& address);

}  // namespace shoal::launch
