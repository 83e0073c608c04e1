// SPDX-License-Identifier: Apache-2.0
// The lines that a run begins with: what it consists of, what it will cost, where to watch it.
#pragma once

#include <filesystem>
#include <string>

#include "common/config/run_files.h"
#include "launch/run/run_request.h"

namespace shoal::launch {

// Each line ended. `address` is claimed. Throws Error where the CPU lacks the asked precision.
std::string StartText(const RunRequest& request, const std::filesystem::path& run,
                      const ClusterAddress& address);

}  // namespace shoal::launch
