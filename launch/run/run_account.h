// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "common/config/config.h"
#include "common/link/run_topology.h"
#include "launch/record/accounting.h"

namespace shoal::launch {

// Account of records (launch/record/accounting.h) of a run whose processes have exited, computed
// from the files in its folder. Empty if no record was ever made. Throws Error if a file cannot be
// read.
std::optional<Accounting> AccountRun(const std::filesystem::path& run, const Config& config,
                                     const link::RunTopology& topology, uint64_t resends);

}  // namespace shoal::launch
